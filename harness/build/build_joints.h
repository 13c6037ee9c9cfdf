// SPDX-License-Identifier: Apache-2.0
// From entries to joints and parts: what hangs on what, and what belongs to what.
// Tested by tests/harness/build/build_joints_test.cc
#pragma once

#include "harness/format/scenario_yaml.h"
#include "harness/yaml/diagnostic_list.h"
#include "physics/scene/scene.h"

namespace prehend::harness {

/// The joints, in the order of their entities. Complains about entities that are unknown, that hang
/// on themselves, or that are fixed to something that cannot move.
std::vector<physics::Joint> BuildJoints(const ScenarioYaml& entry, DiagnosticList& errors);

/// For every entity the index of the one that it is part of, or grammar::kNoEntity. Complains about
/// unknown names and about entities that are, directly or not, parts of themselves.
std::vector<int> PartsOf(const ScenarioYaml& entry, DiagnosticList& errors);

}  // namespace prehend::harness
