// SPDX-License-Identifier: Apache-2.0
// Static checks of a golden: its events, roles, values and names exist in the scenario and its
// grammar. Whether they are recognised is up to `check`. Tested by
// tests/program/golden_workflow_test.cc
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "grammar/base/timeline.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/truth/golden/golden.h"
#include "harness/truth/timeline/match_events.h"

namespace prehend::suite {

// A run against the physical oracle's view of it: which recognised events follow from the
// definitions. A golden's header keeps the count. Tested by
// tests/harness/suite/judge/compare_with_oracle_test.cc

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

/// The golden of the scenario `id`, loaded without changes.
grammar::Diagnostics ValidateGolden(const std::string& path, const std::string& id,
                                    const episode::LoadedRun& loaded);

/// A golden anywhere: below golden/ its place says of which scenario it is, elsewhere its header.
/// `inputs` gets every path that was read or looked for.
grammar::Diagnostics ValidateGoldenFile(const std::string& path, const std::string& root,
                                        std::vector<std::string>& inputs);

struct UnreferencedGolden {
  std::string scenario;  ///< skill/name of the one that does not exist
  std::vector<std::filesystem::path> files;
};

/// Sorted by scenario; `all` is every scenario of the project.
std::vector<UnreferencedGolden> FindUnreferencedGoldens(
    const std::vector<episode::ScenarioFile>& all, const std::string& root);

/// One line per file: "FILE belongs to no scenario: remove it, or bring scenarios/ID.yaml back".
std::string Text(const UnreferencedGolden& orphan);

/// The golden pictures of a scenario beyond the first `asked`.
std::vector<std::filesystem::path> UnrequestedPictures(const std::string& scenario,
                                                       std::size_t asked, const std::string& root);

/// "FILE belongs to no picture: the scenario asks for 1".
std::string UnrequestedText(const std::filesystem::path& picture, std::size_t asked);

// The golden that a run proposes: the recognised events, and everything that people wrote into the
// old one. Tested by tests/harness/suite/judge/accept_golden_test.cc

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
