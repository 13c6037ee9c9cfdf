// SPDX-License-Identifier: Apache-2.0
// Follows the script on paper: where does each step leave the thing that a hand holds? What is put
// down beside its support, or where another thing stands, is an error before anything runs. Tested
// by tests/harness/scenario/resolve/validate_put_downs_test.cc
#pragma once

#include "harness/base/yaml/diagnostic_list.h"
#include "harness/scenario/format/scenario_yaml.h"
#include "physics/scene/scene.h"

namespace prehend::scenario {

/// Reports each `place_on` with no part of the support below the thing, with the thing's centre
/// beside the support, or with another thing in the way by more than a centimetre. The scene is the
/// one that was built of `entry`. What the script does not say (where a thing is that was pushed,
/// dropped, led by way-points or moved on a joint) is not judged.
void ValidatePutDowns(const ScenarioYaml& entry, const physics::Scene& scene,
                      DiagnosticList& errors);

}  // namespace prehend::scenario
