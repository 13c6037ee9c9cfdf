// SPDX-License-Identifier: Apache-2.0
// The fields of `vary:` and `outcomes:`, and what has to fit the rest of the scenario.
// Tested by tests/harness/vary_test.cc and tests/harness/outcome_test.cc
#pragma once

#include "harness/format.h"
#include "harness/trials.h"
#include "physics/scene.h"
#include "physics/script.h"

namespace prehend::harness {

Format<VariationEntry> VariationFormat();
Format<std::vector<ConditionEntry>> OutcomeFormat();

/// Complains about unknown entities, about joints that are asked for but not there, and about
/// moments after the end.
std::vector<Outcome> BuildOutcomes(const std::vector<Named<std::vector<ConditionEntry>>>& entries,
                                   const physics::Scene& scene, const physics::Script& script,
                                   Complaints& complaints);

}  // namespace prehend::harness
