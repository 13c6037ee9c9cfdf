// SPDX-License-Identifier: Apache-2.0
// What the grammar is told of a scenario before its first frame: the entities, in the order of
// their indices in a Frame. Tested by tests/harness/read/read_scenario_test.cc and
// tests/harness/sense/sensing_test.cc
#pragma once

#include <string>
#include <vector>

#include "grammar/base/frame.h"
#include "harness/scenario/scenario.h"
#include "physics/scene/scene.h"

namespace prehend::harness {

/// The grasp styles of all hands, each name once, in the order of the hands: what
/// grammar::HandSample::style indexes, while a snapshot counts in its own hand's list.
std::vector<std::string> StyleNames(const physics::Scene& scene);

/// Who can be bound to roles: the scene's bodies first (same index), then its hands.
grammar::EntityTable MakeEntityTable(const Scenario& scenario);

}  // namespace prehend::harness
