// SPDX-License-Identifier: Apache-2.0
// The keys name, after and with of the script's steps. Tested by
// tests/harness/scenario/resolve/step_order_test.cc
#pragma once

#include "harness/base/yaml/diagnostic_list.h"
#include "harness/scenario/format/scenario_yaml.h"
#include "physics/motion/script.h"
#include "physics/scene/scene.h"

namespace prehend::scenario {

/// What a step says about its turn.
const StepTimingYaml& TimingOf(const StepYaml& step);
physics::StepOrder OrderOf(const StepYaml& step);

/// What ends a step before its time, checked. `is_person`: the step is one of a person.
std::optional<physics::Until> UntilOf(const StepYaml& step, const physics::Scene& scene,
                                      bool is_person, DiagnosticList& errors);

/// Reports names that a stage has twice or not at all, and steps that wait for each other. `script`
/// is what was built of `stages`; `actors` are the names of all, `persons` those of persons.
void CheckStepOrder(const std::vector<StageYaml>& stages, const std::vector<std::string>& actors,
                    const std::vector<std::string>& persons, const physics::Script& script,
                    DiagnosticList& errors);

// From entries to the steps of persons. Tested by
// tests/harness/scenario/resolve/build_persons_test.cc

/// Reports steps that are for hands, unknown entities to look at, and limbs that follow a hand.
physics::PersonStep MakePersonStep(const Named<StepYaml>& step, int person,
                                   const physics::Scene& scene, DiagnosticList& errors);

}  // namespace prehend::scenario
