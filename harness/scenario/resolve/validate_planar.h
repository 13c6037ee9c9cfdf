// SPDX-License-Identifier: Apache-2.0
// What a planar world cannot simulate: everything outside the plane y = 0, or that moves or rotates
// out of it. Tested by tests/harness/scenario/resolve/validate_planar_test.cc
#pragma once

#include "harness/base/yaml/diagnostic_list.h"
#include "harness/scenario/format/scenario_yaml.h"
#include "physics/scene/scene.h"

namespace prehend::scenario {

/// Reports everything in the scenario that does not stay in the plane. The scene is the one that
/// was built of `entry`; bodies, hands and joints stand in the order of their entries.
void ValidatePlanar(const ScenarioYaml& entry, const physics::Scene& scene, DiagnosticList& errors);

}  // namespace prehend::scenario
