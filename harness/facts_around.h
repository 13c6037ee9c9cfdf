// SPDX-License-Identifier: Apache-2.0
// What could be observed where a difference begins: where the participants of both its sides are,
// how fast they move, and who touches them. Shown beside the first difference. Tested by
// tests/harness/facts_around_test.cc
#pragma once

#include <span>
#include <string>

#include "harness/compare.h"
#include "harness/scenario.h"
#include "physics/snapshot.h"

namespace prehend::harness {

/// Lines indented by two blanks; "" without a recording. Touches are raw: nothing is bridged.
std::string FactsAround(const Scenario& scenario, std::span<const physics::Snapshot> recording,
                        const Pairing& difference);

}  // namespace prehend::harness
