// SPDX-License-Identifier: Apache-2.0
// From the written outcomes to conditions on bodies and joints: names become indices. Tested by
// tests/harness/run/outcome_test.cc
#pragma once

#include <vector>

#include "harness/scenario/variations.h"
#include "harness/yaml/diagnostic_list.h"
#include "harness/yaml/value_format.h"
#include "physics/motion/script.h"
#include "physics/scene/scene.h"

namespace prehend::harness {

/// Reports unknown entities, conditions on joints of entities without one, and times after the end.
std::vector<Outcome> BuildOutcomes(const std::vector<Named<std::vector<ConditionYaml>>>& entries,
                                   const physics::Scene& scene, const physics::Script& script,
                                   DiagnosticList& errors);

}  // namespace prehend::harness
