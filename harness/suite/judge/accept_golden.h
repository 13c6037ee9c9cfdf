// SPDX-License-Identifier: Apache-2.0
// The golden that a run proposes: the recognised events, and everything that people wrote into the
// old one. Tested by tests/harness/suite/judge/accept_golden_test.cc
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grammar/base/timeline.h"
#include "harness/suite/judge/compare_with_oracle.h"
#include "harness/truth/golden/golden.h"

namespace prehend::suite {

/// What a new golden says about itself.
struct Proposal {
  std::string scenario;  ///< skill/name
  std::string grammar;
  std::vector<std::string> derived;             ///< empty: keep the old golden's
  std::optional<truth::Acceptance> acceptance;  ///< empty for a pending file
  grammar::Tick tolerance = 0;                  ///< of lines without their own, in ticks of the run
  bool exact = false;                           ///< boundaries that moved within it are taken over
};

/// Lines that agree within their tolerance stay as they are, but with `exact`. A line that does not
/// keeps its comments and its tolerance. Comments of a removed event move above the event of the
/// same name and roles that begins as it did; without one they move to the end, below a line that
/// names the event.
truth::Golden ProposeGolden(const std::optional<truth::Golden>& old,
                            const grammar::Timeline& recognised, const Proposal& proposal);

/// The proposal that a run leaves in build/pending for `review`. Its derivation is the old one's
/// unless the number of events that differ from the ground truth is not what that says.
truth::Golden PendingGolden(const std::optional<truth::Golden>& old,
                            const grammar::Timeline& recognised, const std::string& scenario,
                            const std::string& grammar, const OracleComparison& truth);

/// Its events as a table, one line each.
std::string EventLines(const truth::Golden& golden);

/// Sixteen hexadecimal digits that identify a pending golden.
std::string Fingerprint(const truth::Golden& pending);

/// The command that accepts the pending golden with this fingerprint and nothing else.
/// `grammar`: of a recording that is segmented with another one than it names; or "".
std::string AcceptCommandLine(const std::string& scenario, const std::string& fingerprint,
                              const std::string& grammar = {});

/// The command that accepts the pictures of a scenario.
std::string AcceptPicturesCommand(const std::string& scenario);

}  // namespace prehend::suite
