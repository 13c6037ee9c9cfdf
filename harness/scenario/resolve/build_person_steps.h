// SPDX-License-Identifier: Apache-2.0
// From entries to the steps of persons. Tested by
// tests/harness/scenario/resolve/build_persons_test.cc
#pragma once

#include "harness/base/yaml/diagnostic_list.h"
#include "harness/scenario/format/scenario_yaml.h"
#include "physics/scene/scene.h"

namespace prehend::scenario {

/// Reports steps that are for hands, unknown entities to look at, and limbs that follow a hand.
physics::PersonStep MakePersonStep(const Named<StepYaml>& step, int person,
                                   const physics::Scene& scene, DiagnosticList& errors);

}  // namespace prehend::scenario
