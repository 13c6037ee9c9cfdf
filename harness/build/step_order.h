// SPDX-License-Identifier: Apache-2.0
// The keys name, after and with of the script's steps. Tested by
// tests/harness/build/step_order_test.cc
#pragma once

#include "harness/format/scenario_yaml.h"
#include "harness/yaml/diagnostic_list.h"
#include "physics/motion/script.h"

namespace prehend::harness {

/// What a step says about its turn.
const StepTimingYaml& TimingOf(const StepYaml& step);
physics::StepOrder OrderOf(const StepYaml& step);

/// Reports names that a stage has twice or not at all, and steps that wait for each other. `script`
/// is what was built of `stages`; `actors` are the names of all, `persons` those of persons.
void CheckStepOrder(const std::vector<StageYaml>& stages, const std::vector<std::string>& actors,
                    const std::vector<std::string>& persons, const physics::Script& script,
                    DiagnosticList& errors);

}  // namespace prehend::harness
