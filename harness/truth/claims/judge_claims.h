// SPDX-License-Identifier: Apache-2.0
// Claims against what was recognised. Tested by tests/harness/truth/claims/judge_claims_test.cc
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "grammar/base/frame.h"
#include "grammar/base/timeline.h"
#include "grammar/contents.h"
#include "harness/truth/claims/claim.h"

namespace prehend::truth {

/// The events of a grammar, and who may take part in them.
struct ClaimableEvents {
  std::string grammar;  ///< its name
  std::vector<grammar::EventSignature> events;
  grammar::EntityTable entity_table;
};

/// Entities and grasp styles that are not in the scenario.
std::vector<ClaimProblem> UnknownNames(const Claim& claim, const ClaimableEvents& known);

/// What the claim says of events that this grammar does not have, or not so: no timeline of it can
/// decide the claim.
std::vector<ClaimProblem> Mismatches(const Claim& claim, const ClaimableEvents& known);

/// Whether a recognised event is one of those that are claimed. The claim must have no mismatches.
bool Fits(const grammar::NamedEvent& event, const ClaimedEvent& claimed,
          const ClaimableEvents& known);

/// What became of one claim.
struct ClaimVerdict {
  std::string claim;  ///< as written
  std::string place;  ///< "slide/x.yaml:31"
  std::string says;   ///< kHolds, kContradicted or kNotJudged
  std::string found;  ///< "found 11", or why the claim is not judged
  /// A line for each event that the claim is about; if there is none, for those of its name.
  std::string times;
};
inline constexpr const char* kHolds = "holds";
inline constexpr const char* kContradicted = "contradicted";
inline constexpr const char* kNotJudged = "not judged";

/// One per claim, in their order. `file` is where they were written.
std::vector<ClaimVerdict> JudgeClaims(const std::vector<Claim>& claims, const std::string& file,
                                      const ClaimableEvents& known,
                                      const grammar::Timeline& timeline);

/// "expects: '12 pick_and_place(right_hand, any)' (long/x.yaml:31): found 11"
std::string Text(const ClaimVerdict& verdict);

bool IsContradicted(const ClaimVerdict& verdict);

/// Text() and times of those that are contradicted; several lines or empty.
std::string TextOfContradicted(const std::vector<ClaimVerdict>& verdicts);
/// An object for each: `claim`, `place`, `verdict`, `found`.
nlohmann::ordered_json ClaimsJson(const std::vector<ClaimVerdict>& verdicts);
/// Text() of those that are not judged; several lines or empty.
std::string TextOfUndecided(const std::vector<ClaimVerdict>& verdicts);

}  // namespace prehend::truth
