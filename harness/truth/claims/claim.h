// SPDX-License-Identifier: Apache-2.0
// A claim as data: one line of a scenario's `expects`. It says how many events of a kind happen, or
// how they lie to others in time. docs/scenario-format.md defines what each form means. Tested by
// tests/harness/truth/claims/parse_claim_test.cc
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "grammar/base/allen.h"
#include "grammar/base/diagnostic.h"
#include "harness/base/base/located.h"

namespace prehend::truth {

// Limits of one claim; how many there are and how long, harness/scenario/format/scenario_formats.h
// says.
inline constexpr std::size_t kMaxClaimedEvents = 16;
inline constexpr int kMaxClaimedNumber = 10'000;

/// A value that fits everybody.
inline constexpr std::string_view kAnybody = "any";

/// A part of a claim that can be wrong, and where it begins in the claim's text.
struct ClaimWord {
  std::string text;
  std::size_t offset = 0;
};

/// `milk`, `any` or `hand=right_hand`.
struct ClaimRole {
  ClaimWord name;  ///< of the role or attribute; empty: the role at this place of the head
  ClaimWord value;
};

/// `reaching(right_hand, milk)`: every event that fits.
struct ClaimedEvent {
  ClaimWord name;
  std::vector<ClaimRole> roles;  ///< those that are not given fit everybody
};

enum class Quantity {
  kAtLeast,
  kAtMost,
  kExactly,
  kEvery,  ///< and at least one
};

/// Counts the events that fit `events[0]` and lie as `relations[0]` says to another one, which fits
/// `events[1]` and lies as `relations[1]` says to a third one, and so on.
struct Claim {
  Quantity quantity = Quantity::kAtLeast;
  int number = 1;                            ///< unused with kEvery
  std::vector<ClaimedEvent> events;          ///< at least one
  std::vector<grammar::AllenSet> relations;  ///< one fewer
  std::string text;                          ///< as written
  Where where;                               ///< of its first letter
  bool on_one_line = true;                   ///< as in the file: an offset is a distance in columns
};

/// Events of this name are no grammar's: they are what the physics gets wrong, which notes of a run
/// say (physics/scene/run_limits.h). A claim says that it may be.
inline constexpr std::string_view kLimitEvents[] = {"goes_through", "sinks_into"};
bool IsAboutLimit(const Claim& claim);

/// Where the part of a claim at this offset was written; the claim's begin if that is not known.
inline Where PlaceIn(const Claim& claim, std::size_t offset) {
  Where where = claim.where;
  if (claim.on_one_line) where.place.column += static_cast<int>(offset);
  return where;
}

// The text of a claim -> the claim. Tested by tests/harness/truth/claims/parse_claim_test.cc

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
