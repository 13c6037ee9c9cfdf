// SPDX-License-Identifier: Apache-2.0
// From the written steps to physics::Script: names become indices, roll-pitch-yaw becomes
// quaternions. Tested by tests/harness/scenario/read/read_scenario_test.cc
#pragma once

#include "harness/base/yaml/diagnostic_list.h"
#include "harness/scenario/format/scenario_yaml.h"
#include "physics/scene/scene.h"

namespace prehend::scenario {

/// Reports unknown actors, entities and styles, approaches that a style does not have, and a script
/// that is too long. `scene` has the hands and persons of `entry`, in that order; hands without
/// styles are not checked for theirs.
physics::Script BuildScript(const ScenarioYaml& entry, const physics::Scene& scene,
                            DiagnosticList& errors);

}  // namespace prehend::scenario
