// SPDX-License-Identifier: Apache-2.0
// A run against the claims of its scenario. Tested by
// tests/harness/suite/judge/judge_claims_test.cc
#pragma once

#include <vector>

#include "grammar/base/timeline.h"
#include "harness/suite/judge/judge.h"
#include "harness/truth/claims/judge_claims.h"

namespace prehend::suite {

/// Said of a scenario that contradicts its claims.
inline constexpr const char* kUntilClaimsHold =
    "it cannot be accepted until its claims hold: change the script so that it plays what the "
    "scenario shows, or fix what is recognised";

/// `timeline` is what the grammar of `loaded` recognised.
std::vector<truth::ClaimVerdict> JudgeClaims(const episode::LoadedRun& loaded,
                                             const grammar::Timeline& timeline);

/// One per contradicted claim.
Findings ClaimFindings(const std::vector<truth::ClaimVerdict>& verdicts);

}  // namespace prehend::suite
