// SPDX-License-Identifier: Apache-2.0
// The golden that a run proposes: the recognised events, with everything that people wrote into the
// old one kept. Tested by tests/harness/accept_golden_test.cc
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grammar/timeline.h"
#include "harness/derivation.h"
#include "harness/golden.h"

namespace prehend::harness {

/// What a new golden says about itself.
struct Proposal {
  std::string scenario;  ///< skill/name
  std::string grammar;
  std::vector<std::string> derived;      ///< empty: keep the old golden's
  std::optional<Acceptance> acceptance;  ///< empty for a pending file
  std::vector<OracleNote> notes;         ///< what the oracle sees otherwise
  grammar::Tick tolerance = 0;           ///< of lines without their own, in ticks of the run
};

/// Lines that agree within their tolerance stay as they are. Of the others comments and tolerances
/// stay with the event they belong to; comments above events that are gone stay above the
/// event of the same name and roles that begins as they did, or stand at the end, below a line that
/// says which event that was. What the oracle sees otherwise keeps the reason that
/// people gave for it; what it did not before has kReasonWanted.
Golden ProposeGolden(const std::optional<Golden>& old, const grammar::Timeline& recognised,
                     const Proposal& proposal);

/// What a run leaves below build/pending, and `review` shows.
Golden PendingGolden(const std::optional<Golden>& old, const grammar::Timeline& recognised,
                     const std::string& scenario, const std::string& grammar,
                     const Derivation& derivation);

/// Eight hexadecimal digits, which tell one pending golden from another.
std::string Fingerprint(const Golden& pending);

/// What accepts the pending golden of that fingerprint and nothing else, to be typed; with the
/// option for it when an objection of the physical oracle wants a reason.
std::string AcceptCommandLine(const std::string& scenario, const std::string& fingerprint,
                              bool wants_reason);

}  // namespace prehend::harness
