// SPDX-License-Identifier: Apache-2.0
// A run against the physical oracle's view of it: which recognised events follow from the
// definitions. A golden's header keeps the count. Tested by
// tests/harness/suite/judge/compare_with_oracle_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/episode/run/run_scenario.h"
#include "harness/truth/timeline/match_events.h"

namespace prehend::suite {

/// The program writes the lines of a golden that begin so and renews them with every acceptance;
/// people write the others.
inline constexpr const char* kOracleLine = "oracle: ";

/// How far a run agrees with the ground truth.
struct OracleComparison {
  truth::Agreement agreement;
  grammar::Tick tolerance = 0;  ///< two sensing frames; a boundary further outside its band differs
  int judged = 0;               ///< recognised events of kinds that the definitions have
  int not_judged = 0;           ///< recognised events of other kinds

  /// Recognised events that follow, with both boundaries within the tolerance.
  int Following() const;
  /// Events that do not follow, and events that follow but are not recognised.
  int Differing() const;
};

/// The run must have been recorded.
OracleComparison CompareWithOracle(const scenario::Scenario& scenario,
                                   const grammar::Program& program, const episode::RunResult& run);

/// "oracle: 12 of 12 events follow from the definitions of docs/events.md"
std::string OracleLine(const OracleComparison& compared);

/// One line per event that differs:
/// "ground truth: reaching(right_hand, cup) begins 183.3 ms earlier than recognised; its end agrees
/// (recognised 1.2000..2.0000 s)"
std::string GroundTruthText(const OracleComparison& compared);

/// "no event differs from the ground truth", "1 event differs ..", "2 events differ .."
std::string DifferingText(int differing);

/// How many events differ according to the line of a golden that OracleLine() wrote; none without
/// such a line.
int AcceptedDiffering(const std::vector<std::string>& derived);

/// People's lines, then the oracle's.
std::vector<std::string> RenewedDerivation(const std::vector<std::string>& lines,
                                           const std::string& oracle_line);

}  // namespace prehend::suite
