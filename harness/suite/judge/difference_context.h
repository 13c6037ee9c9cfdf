// SPDX-License-Identifier: Apache-2.0
// What was sensed where a difference begins: position, speed and contacts of the participants of
// both sides. Shown with the first difference. Tested by
// tests/harness/suite/judge/difference_context_test.cc
#pragma once

#include <span>
#include <string>

#include "harness/scenario/scenario/scenario.h"
#include "harness/truth/golden/compare.h"
#include "physics/scene/snapshot.h"

namespace prehend::suite {

/// Lines indented by two blanks; "" without a recording. Contacts are as sensed: no gap is
/// tolerated.
std::string DifferenceContext(const scenario::Scenario& scenario,
                              std::span<const physics::Snapshot> recording,
                              const truth::Pairing& difference);

}  // namespace prehend::suite
