// SPDX-License-Identifier: Apache-2.0
// A run against the claims of its scenario. Tested by tests/harness/judge/judge_claims_test.cc
#pragma once

#include <vector>

#include "grammar/base/timeline.h"
#include "harness/claims/judge_claims.h"
#include "harness/judge/judge.h"

namespace prehend::harness {

/// Said of a scenario that contradicts its claims.
inline constexpr const char* kUntilClaimsHold =
    "it cannot be accepted until its claims hold: change the script so that it plays what the "
    "scenario shows, or fix what is recognised";

/// `timeline` is what the grammar of `loaded` recognised.
std::vector<ClaimVerdict> JudgeClaims(const LoadedRun& loaded, const grammar::Timeline& timeline);

/// One per contradicted claim.
Findings ClaimFindings(const std::vector<ClaimVerdict>& verdicts);

}  // namespace prehend::harness
