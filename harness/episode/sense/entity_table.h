// SPDX-License-Identifier: Apache-2.0
// What a grammar knows of a scenario before its first frame: the entities, in the order of their
// indices in a Frame. Tested by tests/harness/scenario/read/read_scenario_test.cc and
// tests/harness/episode/sense/sensing_test.cc
#pragma once

#include <string>
#include <vector>

#include "grammar/base/frame.h"
#include "harness/scenario/scenario/scenario.h"
#include "physics/scene/scene.h"

namespace prehend::episode {

/// The grasp styles of all hands, each name once, in the order of the hands.
/// grammar::HandSample::style is an index into this list; a snapshot's style is one into the list
/// of its own hand.
std::vector<std::string> StyleNames(const physics::Scene& scene);

/// The entities that can be bound to roles: the scene's bodies (same index), then its hands.
grammar::EntityTable MakeEntityTable(const scenario::Scenario& scenario);

}  // namespace prehend::episode
