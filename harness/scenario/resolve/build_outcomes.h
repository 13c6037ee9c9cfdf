// SPDX-License-Identifier: Apache-2.0
// From the written outcomes to conditions on bodies and joints: names become indices. Tested by
// tests/harness/episode/run/outcome_test.cc
#pragma once

#include <vector>

#include "harness/base/yaml/diagnostic_list.h"
#include "harness/base/yaml/value_format.h"
#include "harness/scenario/scenario/variations.h"
#include "physics/motion/script.h"
#include "physics/scene/scene.h"

namespace prehend::scenario {

/// Reports unknown entities, conditions on joints of entities without one, and times after the end.
std::vector<Outcome> BuildOutcomes(const std::vector<Named<std::vector<ConditionYaml>>>& entries,
                                   const physics::Scene& scene, const physics::Script& script,
                                   DiagnosticList& errors);

}  // namespace prehend::scenario
