// SPDX-License-Identifier: Apache-2.0
// The text of a claim -> the claim. Tested by tests/harness/truth/claims/parse_claim_test.cc
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "harness/truth/claims/claim.h"

namespace prehend::truth {

/// What is wrong in the text of a claim, and where.
struct ClaimProblem {
  std::size_t offset = 0;
  std::string message;  ///< what was found, what was wanted
  std::string hint;     ///< the remedy or the nearest known name; may be empty
};

/// The result has no place yet: `where` is up to the caller.
tl::expected<Claim, ClaimProblem> ParseClaim(std::string_view text);

/// "did you mean 'milk'?", or a short list of what is known, or "".
std::string HintForName(std::string_view name, const std::vector<std::string>& known);

}  // namespace prehend::truth
