// SPDX-License-Identifier: Apache-2.0
// The suite as one web page, one file that works offline: causes of failures, verdicts with what
// failed first, timelines (golden above recognised), pictures, differences, and the commands that
// show them again. Tested by tests/harness/suite/report/report_test.cc
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <pugixml.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/show/replay/replay_data.h"
#include "harness/suite/check/explained.h"
#include "harness/suite/check/verdict.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::suite {

// What became of each scenario in the last runs: a file with a line of JSON for each run. Tested by
// tests/harness/suite/report/history_test.cc

inline constexpr std::size_t kMostPastRuns = 20;

struct PastVerdict {
  std::string verdict;
  double seconds = 0;
  std::optional<double> margin_ms;  ///< the smallest one; none if all boundaries are exact
};

struct PastRun {
  std::string date, commit;
  std::map<std::string, PastVerdict> scenarios;
};

PastRun RunOf(const std::vector<ScenarioVerdict>& verdicts, const std::string& date,
              const std::string& commit);

/// The last of them, the oldest first. Lines that are damaged are left out.
std::vector<PastRun> ReadHistory(const std::string& file);

/// Returns "" or what went wrong.
std::string WriteHistory(const std::string& file, const std::vector<PastRun>& runs);

/// For the script of the page: {"runs": [DATE, ..], "of": {SCENARIO: [[RUN, VERDICT, SECONDS,
/// MARGIN or null], ..]}}.
nlohmann::json HistoryJson(const std::vector<PastRun>& runs);

// The charts of the report page: a comparison with its golden, and the signals that decided. Tested
// by tests/harness/suite/report/charts_test.cc

/// One row per event and roles, with the interval of the golden above the recognised one, as an
/// <svg> element. `end` is the episode's end in the comparison's ticks. Without a golden nothing
/// differs.
std::string TimelineSvg(const truth::Comparison& comparison, grammar::Tick end,
                        const truth::EventDrawings& drawings, bool has_golden = true);

/// Who says what happened: people's labels, grammars, programs. None: a golden and a run.
using Sides = std::vector<std::string>;

/// The same of several sides: those after the first are each compared with it. A row has a lane for
/// each, and one for where they differ. Above all are the steps of the script.
std::string TimelineSvg(std::span<const truth::Comparison> comparisons, const Sides& sides,
                        grammar::Tick end, const truth::EventDrawings& drawings, bool has_golden,
                        std::span<const show::PlayedStep> steps);

/// A signal over time: its value, its limit, and when the one crossed the other, as an <svg>
/// element. The signal has at least one sample.
std::string SignalSvg(const DecidingSignal& signal, grammar::Tick ticks_per_second);

/// Adds an explanation for each difference, the first one unfolded, with its signals; and as data
/// what turned at each boundary, which the page's script shows at the cursor.
void AddExplanations(pugi::xml_node section, const Explained& explained,
                     grammar::Tick ticks_per_second);

/// Adds the last runs as data, for the page's script.
void AddHistory(pugi::xml_node body, const std::vector<PastRun>& history);

// Texts of the report page, embedded when the program is built: its style and script
// (harness/suite/report/page), and the script of the 3D replay (harness/suite/report/replay).

std::string_view PageStyle();
std::string_view PageScript();

/// The script of the 3D replay, deflated, in base64; empty in a build that could not get it.
std::string_view ReplayBundle();
/// Why there is none; else empty.
std::string_view WhyNoReplay();

/// "grasping(hand=right_hand, object=milk)", as labels are saved.
std::string WithRoles(const grammar::NamedEvent& event);

struct ReportTable {
  std::string title;
  std::vector<std::vector<std::string>> rows;  ///< the first is its head
};

struct ReportHeader {
  std::string command;      ///< that made the page
  std::string date;         ///< YYYY-MM-DD
  std::string commit = {};  ///< of the project: "1a2b3c4d5e, with changes"; "": it is not known
  std::string machine = {};
  std::string folder = {};  ///< what the files of pictures are relative to
  std::string title = "Regression suite";
  std::vector<PastRun> history = {};  ///< of the same scenarios, with this run
  /// Not empty: not runs and goldens are compared, but what these say of the same takes. Verdicts
  /// have a comparison of the second with the first, and in `labelled` those of the further ones.
  Sides sides = {};
  std::vector<ReportTable> tables = {};
  std::string scores = {};  ///< as text
};

/// With the commit that `root` is at, and this machine.
ReportHeader HeaderOf(const std::string& command, const std::string& root, const std::string& date);

/// Pictures are in the page, those of failures first, up to this size (as text) in all; of the
/// others the page says that they lie beside it.
inline constexpr std::size_t kMostPictureBytes = 15'000'000;

/// The same for 3D replays.
inline constexpr std::size_t kMostReplayBytes = 10'000'000;

std::string ReportHtml(const std::vector<ScenarioVerdict>& verdicts, const ReportHeader& header);

/// Differences and pending goldens are failures, what could not be read or did not end is an error,
/// what nothing changed for is skipped. The class of a case is its skill.
std::string JunitXml(const std::vector<ScenarioVerdict>& verdicts);

}  // namespace prehend::suite
