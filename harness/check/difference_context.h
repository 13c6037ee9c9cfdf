// SPDX-License-Identifier: Apache-2.0
// What could be observed where a difference begins: where the participants of both its sides are,
// how fast they move, and who touches them. Shown beside the first difference. Tested by
// tests/harness/check/difference_context_test.cc
#pragma once

#include <span>
#include <string>

#include "harness/golden/compare.h"
#include "harness/scenario/scenario.h"
#include "physics/scene/snapshot.h"

namespace prehend::harness {

/// Lines indented by two blanks; "" without a recording. Touches are raw: nothing is bridged.
std::string FactsAround(const Scenario& scenario, std::span<const physics::Snapshot> recording,
                        const Pairing& difference);

}  // namespace prehend::harness
