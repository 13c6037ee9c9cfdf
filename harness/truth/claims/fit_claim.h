// SPDX-License-Identifier: Apache-2.0
// A claim against the names that it uses: what the scenario and its grammar have, and which events
// fit. Tested by tests/harness/truth/claims/fit_claim_test.cc
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grammar/base/frame.h"
#include "grammar/base/timeline.h"
#include "grammar/contents.h"
#include "harness/truth/claims/claim.h"
#include "harness/truth/claims/parse_claim.h"

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

}  // namespace prehend::truth
