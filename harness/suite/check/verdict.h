// SPDX-License-Identifier: Apache-2.0
// What `prehend check` found out about one scenario: a value that the worker sends to its parent,
// and that the report, JUnit and JSON are made from. Tested by
// tests/harness/suite/check/verdict_test.cc
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "harness/base/base/content_hash.h"
#include "harness/base/base/exit_code.h"
#include "harness/base/base/result.h"
#include "harness/show/replay/replay_data.h"
#include "harness/suite/check/explained.h"
#include "harness/suite/check/settings.h"
#include "harness/suite/judge/judges.h"
#include "harness/truth/claims/judge_claims.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::suite {

enum class Verdict {
  kPassed,
  kFailed,
  kPending,    ///< there is no golden yet
  kFlaky,      ///< repeated runs did not agree
  kUnchanged,  ///< passed before, and nothing that it depends on changed since: not run again
};

/// "passed", "failed", ...
std::string_view Name(Verdict verdict);

struct ReportedPicture {
  std::string file;  ///< relative to the report
  std::string caption;
};

/// The scene when the golden says that an event begins or ends, and when it was recognised; or
/// where an event begins that only one of them has.
struct DrawnDifference {
  std::string what;  ///< "begin of reaching(right_hand, milk)", or only the event
  ReportedPicture expected = {}, recognised = {};
  bool in_golden = true, in_run = true;  ///< who has the event
};

/// Of one scenario.
inline constexpr std::size_t kMostDrawnDifferences = 3;

/// Of a take whose events are compared with labels, beside the first comparison.
struct Labelled {
  std::vector<truth::Comparison> others;  ///< of further sides with the labels
  std::string video = {};                 ///< as the page names it; "": there is none
  double offset_s = 0;                    ///< where its time 0 is in the take
  std::vector<std::pair<double, grammar::NamedEvent>> moments = {};  ///< labels, with seconds
};

/// The reason of what passes but for a picture.
inline constexpr const char* kPictureDiffers = "a picture differs from its golden";

struct ScenarioVerdict {
  std::string scenario;  ///< skill/name
  std::string file;      ///< what was checked
  std::string shows;
  Verdict verdict = Verdict::kFailed;
  ExitCode exit_code = ExitCode::kAgrees;   ///< what a check of this scenario alone ends with
  std::string reason;                       ///< one line; empty when passed
  grammar::Diagnostics errors;              ///< of its input
  std::string details;                      ///< differences, violations; several lines or empty
  std::string warnings;                     ///< of a recording: MissingFacts::warnings
  std::vector<std::string> notes;           ///< NoteLines(): steps that did not do what they say
  std::vector<truth::ClaimVerdict> claims;  ///< of a run that completed
  std::optional<truth::Comparison>
      comparison;                 ///< with the golden; without one every event is extra
  bool has_golden = false;        ///< there is one, and it could be read
  truth::EventDrawings drawings;  ///< how the grammar wants the comparison drawn
  std::string explain;            ///< the command that asks about the scenario's events
  std::string cause;              ///< CauseText(): what the differences are attributed to; or empty
  std::vector<Attribution> attributions;  ///< one for each of comparison->Differing(), or none
  Settings settings;                      ///< what its files say, value by value
  std::string command;  ///< repeats the check; of what is pending, shows what to accept
  std::string state_hash;
  std::int64_t ticks = 0;
  double seconds = 0;                ///< wall time in its worker
  std::int64_t peak_memory_kib = 0;  ///< of its worker
  FileHashes inputs;  ///< every file that decides what the verdict is, as it was before the run
  std::vector<ReportedPicture> pictures;
  std::vector<DrawnDifference> drawn_differences;  ///< at most kMostDrawnDifferences
  std::optional<Demonstration> demonstration;      ///< of a robot, by a recording
  Explained explained;                             ///< of what has a golden and did not pass
  std::vector<show::PlayedStep> steps;             ///< of its script
  std::string replay;  ///< ReplayData() (harness/show/replay/replay_data.h), or empty
  std::string
      not_recorded;  ///< empty, or why the episode is not in its file; no part of the verdict
  std::string picture_differences;  ///< several lines; only one of several repetitions draws
  Labelled labelled;                ///< of ReportHeader::sides; no worker knows it

  bool DiffersFromGolden() const { return has_golden && comparison && !comparison->Agrees(); }
};

/// What to look at first: the first error in what was read, the first claim that does not hold, or
/// the beginning of the file. Below the working directory the path is relative to it.
struct FirstPlace {
  std::string file;
  int line = 1;
};
FirstPlace WhereToLook(const ScenarioVerdict& verdict);

/// Whether it is pending and its command shows what can be accepted.
bool LeadsToReview(const ScenarioVerdict& verdict);

/// What stands before its command: "again", or "next" of one that leads on.
std::string_view CommandLabel(const ScenarioVerdict& verdict);

/// Its errors and details; several lines or empty.
std::string DetailsText(const ScenarioVerdict& verdict);

/// The smallest margin of what passed; else empty.
std::string MarginText(const ScenarioVerdict& verdict);

/// The notes, a line each; of what passed, their number; or "".
std::string NotesText(const ScenarioVerdict& verdict);

/// As `--json` prints them: file, line, column, message, hint.
nlohmann::ordered_json DiagnosticsJson(const grammar::Diagnostics& diagnostics);

/// As `prehend check --json` prints it: keys in docs/regression-suite.md.
nlohmann::ordered_json VerdictJson(const ScenarioVerdict& verdict);

/// Every field, for another process of the same program. Unpacking throws
/// nlohmann::json::exception when a field is missing or of another type.
nlohmann::json Packed(const ScenarioVerdict& verdict);
ScenarioVerdict UnpackedVerdict(const nlohmann::json& packed);

/// The verdict of one or several runs of a scenario: their common one, or kFlaky when they differ
/// in anything but time, memory and pictures. Of these the largest is kept. A scenario that passed
/// fails when a picture differs. Needs at least one run.
ScenarioVerdict MergeRepeats(const std::vector<ScenarioVerdict>& runs);

struct Tally {
  int passed = 0, failed = 0, pending = 0, unchanged = 0;  ///< `failed` includes the flaky ones
};
Tally Count(const std::vector<ScenarioVerdict>& verdicts);

/// The smallest margin of all boundaries that are not exact:
/// "smallest margin: 4.2 of 8.3 ms left at .. of SCENARIO"; "" when all are exact.
std::string SmallestMarginText(const std::vector<ScenarioVerdict>& verdicts);

/// How the whole check ends: the worst of its scenarios.
ExitCode WorstOf(const std::vector<ScenarioVerdict>& verdicts);

}  // namespace prehend::suite
