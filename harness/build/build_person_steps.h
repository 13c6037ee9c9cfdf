// SPDX-License-Identifier: Apache-2.0
// From entries to the steps of persons. Tested by tests/harness/build/build_persons_test.cc
#pragma once

#include "harness/format/scenario_yaml.h"
#include "harness/yaml/diagnostic_list.h"
#include "physics/scene/scene.h"

namespace prehend::harness {

/// Reports steps that are for hands, unknown entities to look at, and limbs that follow a hand.
physics::PersonStep MakePersonStep(const Named<StepYaml>& step, int person,
                                   const physics::Scene& scene, DiagnosticList& errors);

}  // namespace prehend::harness
