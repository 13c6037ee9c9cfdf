// SPDX-License-Identifier: Apache-2.0
// From entities to joints and parts: what is attached to what, and what is part of what. Tested by
// tests/harness/scenario/resolve/build_joints_test.cc
#pragma once

#include "harness/base/yaml/diagnostic_list.h"
#include "harness/scenario/format/scenario_yaml.h"
#include "physics/scene/scene.h"

namespace prehend::scenario {

/// The joints, in the order of their entities. Reports entities that are unknown, that are attached
/// to themselves, or that are fixed to something that cannot move.
std::vector<physics::Joint> BuildJoints(const ScenarioYaml& entry, DiagnosticList& errors);

/// For every entity the index of the one that it is part of, or grammar::kNoEntity: what is glued
/// to another entity is a part of it unless it says otherwise. Reports unknown names and entities
/// that are, directly or not, parts of themselves.
std::vector<int> PartsOf(const ScenarioYaml& entry, DiagnosticList& errors);

}  // namespace prehend::scenario
