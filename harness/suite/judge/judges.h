// SPDX-License-Identifier: Apache-2.0
// What can be wrong with a run, judge by judge. What the judges of a check are given, and what they
// return: a run with what it was played from, and findings. Tested by
// tests/harness/suite/judge/judge_golden_test.cc and tests/harness/suite/judge/judge_claims_test.cc
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/base/timeline.h"
#include "grammar/check_laws.h"
#include "grammar/describe.h"
#include "harness/base/base/exit_code.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/episode/run/segment_recording.h"
#include "harness/episode/run/task_files.h"
#include "harness/episode/sense/episode_file.h"
#include "harness/scenario/scenario/scenario.h"
#include "harness/show/pictures/pictures.h"
#include "harness/suite/judge/validate_golden.h"
#include "harness/truth/claims/judge_claims.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/golden/golden.h"
#include "harness/truth/timeline/event_text.h"
#include "physics/scene/snapshot.h"

namespace prehend::suite {

/// Something that a check found wrong.
struct Finding {
  ExitCode exit_code = ExitCode::kDiffers;  ///< of a check that finds only this
  std::string reason;                       ///< one line
  std::string details;                      ///< several lines or empty
  grammar::Diagnostics errors = {};         ///< of its input
};
using Findings = std::vector<Finding>;

inline void Append(Findings& findings, Findings more) {
  findings.insert(findings.end(), std::make_move_iterator(more.begin()),
                  std::make_move_iterator(more.end()));
}

/// A scenario that was played to its end, and recorded.
struct CheckedRun {
  std::string id;          ///< skill/name
  bool in_project = true;  ///< below scenarios/, so that it may have a golden
  episode::LoadedRun loaded;
  episode::RunResult result;
  std::string explain;  ///< the command that asks about its events
  /// Of one that was recorded, what it was made from: its files are read from copies.
  episode::TaskFiles task = {};
  bool is_trial = false;  ///< of other values of all that its scenario varies
};

/// Said of a scenario that contradicts its claims.
inline constexpr const char* kUntilClaimsHold =
    "it cannot be accepted until its claims hold: change the script so that it plays what the "
    "scenario shows, or fix what is recognised";

/// `timeline` is what the grammar of `loaded` recognised.
std::vector<truth::ClaimVerdict> JudgeClaims(const episode::LoadedRun& loaded,
                                             const grammar::Timeline& timeline);

/// Of claims that the physics gets something wrong, by what a run notes.
std::vector<truth::ClaimVerdict> JudgeLimitClaims(const scenario::Scenario& scenario,
                                                  const std::vector<physics::ScriptNote>& notes);

/// One per note of a run that the physics got something wrong, which the scenario does not expect;
/// one per such thing that it expects and that did not happen.
Findings JudgeLimits(const scenario::Scenario& scenario,
                     const std::vector<physics::ScriptNote>& notes);

/// One per contradicted claim.
Findings ClaimFindings(const std::vector<truth::ClaimVerdict>& verdicts);

// A run against its golden and the ground truth.

struct GoldenComparison {
  bool has_golden = false;  ///< false: the comparison is with an empty one
  truth::Comparison comparison;
  OracleComparison truth;
  int accepted_differing = 0;  ///< from the ground truth, by the golden
  truth::Golden pending;       ///< what the run proposes

  bool Differs() const { return has_golden && !comparison.Agrees(); }
  bool TruthIsAccepted() const { return truth.Differing() == accepted_differing; }
  /// Nothing waits for review.
  bool Holds() const { return has_golden && comparison.Agrees() && TruthIsAccepted(); }
};

GoldenComparison CompareWithGolden(const std::optional<truth::Golden>& golden,
                                   const CheckedRun& checked);

/// Of a comparison that does not agree. `explain`: the command that asks about the events; `facts`
/// are shown with the first difference.
Finding DifferenceFinding(const truth::Comparison& comparison, const std::string& explain,
                          const std::string& facts = {});

/// `cause` is CauseText() of a run that differs. Without a golden the finding is that there is
/// none.
Findings JudgeGolden(const GoldenComparison& compared, const CheckedRun& checked,
                     const std::string& cause);

/// Lines indented by two blanks; "" without a recording. Contacts are as sensed: no gap is
/// tolerated.
std::string DifferenceContext(const scenario::Scenario& scenario,
                              std::span<const physics::Snapshot> recording,
                              const truth::Pairing& difference);

// A recording of a tracker against its golden, which lies beside it: take.timeline beside
// take.jsonl. Nothing is simulated, so neither claims nor the oracle are asked. Tested by
// tests/program/golden_of_recording_test.cc

struct JudgedRecording {
  episode::SegmentedRecording segmented;
  std::optional<truth::Golden> golden;
  truth::Comparison comparison;  ///< with the golden, or with an empty one
  std::string golden_file;
  truth::Golden
      proposed;  ///< what the recording yields now, with what people wrote into the golden

  bool Agrees() const {
    return golden && comparison.Agrees() && golden->grammar == proposed.grammar;
  }
};

/// Where the golden of a recording is: beside the file that it comes from. Of a demonstration in an
/// HDF5 file, demos.timelines/demo_3.timeline.
std::string GoldenOf(const episode::EpisodeName& name, const scenario::Scenario& scenario,
                     const std::string& root);

/// "", or why what is kept in an episode file has none: only demonstrations have.
std::string LacksGolden(const episode::EpisodeName& name, const std::string& root);

/// `grammar`: instead of its own, or "". A line of the golden without a tolerance of its own has
/// that of two frames.
Result<JudgedRecording> JudgeRecording(const episode::EpisodeName& name, const std::string& grammar,
                                       const std::string& root);
/// Of lines of its golden without a tolerance of their own.
grammar::Tick ToleranceOf(const episode::SegmentedRecording& segmented);
/// The same of one that is segmented, with this golden.
Result<JudgedRecording> JudgeSegmented(episode::SegmentedRecording segmented,
                                       const std::string& golden_file);

/// A line that says so if the golden is of another grammar than the recording was segmented with.
std::string OtherGrammarText(const JudgedRecording& judged);

/// What there is to accept: all events where there is no golden, else how they differ from it.
/// `explain`: the command that asks about them.
std::string ReviewText(const JudgedRecording& judged, const std::string& explain);

/// JudgedRecording::proposed with the reason why it is right. `derived`: how it follows from the
/// definitions; empty: as the golden says.
truth::Golden AcceptedRecording(const JudgedRecording& judged,
                                const std::vector<std::string>& derived,
                                truth::Acceptance acceptance);

// The pictures of a run against the goldens of pictures.
// Tested by tests/harness/suite/judge/judge_pictures_test.cc

/// A drawn picture that has a golden.
struct PictureComparison {
  std::filesystem::path golden, drawn;
  std::vector<std::string> told;   ///< what tells it from its golden; empty: nothing
  std::filesystem::path shown_in;  ///< where StorePictures() shows what differs; or empty
};

/// The goldens of a scenario's pictures, those that exist.
show::GoldenOf GoldensOf(const std::string& id, const std::string& root);

/// Drawn pictures without a golden are left out. `root` is the project's. With `shown` what differs
/// is to be shown in a picture of its own.
std::vector<PictureComparison> ComparisonsOf(const std::string& id,
                                             const std::vector<show::WrittenPicture>& drawn,
                                             const std::string& root, bool shown);

/// Several lines, or empty. `accept` is the command that accepts the pictures, or empty.
std::string PictureDifferencesText(const std::vector<PictureComparison>& compared,
                                   const std::string& accept);

/// Golden pictures beyond the `requested` ones of the scenario.
Findings JudgeUnrequestedPictures(const std::string& id, std::size_t requested,
                                  const std::string& root, const std::string& accept);

/// Keeps pictures that differ for `prehend review`, and removes those that do not any more.
void StorePictures(const std::string& id, const std::vector<PictureComparison>& compared,
                   const std::string& root);

// What must hold of every timeline, whatever its events mean: begin < end, inside the episode,
// apart from itself, decided in time. A violation is a mistake in the engine. What must hold of
// certain events is said by the laws of their grammar (grammar/check_laws.h). Tested by
// tests/harness/suite/judge/invariants_test.cc

/// What the checkers must know besides the timeline.
struct EpisodeFacts {
  grammar::Tick end = 0;         ///< first tick that no longer belongs to the episode
  grammar::Tick two_frames = 4;  ///< of sensing
  std::map<std::string, grammar::Wait>
      latency;  ///< per event: what its decision may wait for after its end
};

struct Violation {
  std::string_view invariant;  ///< its name in the table
  grammar::Tick tick = 0;      ///< where
  std::string what;            ///< a sentence
};

using Violations = std::vector<Violation>;

struct Invariant {
  std::string_view name;
  std::string_view says;
  void (*check)(const grammar::Timeline& timeline, const EpisodeFacts& facts, std::string_view name,
                Violations& violations);
};

/// All of them.
std::span<const Invariant> Invariants();

/// Runs every checker; violations in the order of the table, then of time.
Violations CheckInvariants(const grammar::Timeline& timeline, const EpisodeFacts& facts);

/// "decisions_come_in_time at 1.2000 s: ..."
std::string Text(const Violation& violation, grammar::Tick ticks_per_second);
/// "slides_are_supported at 1.2000..1.3000 s: ..", and a line with the law itself.
std::string Text(const grammar::LawViolation& violation, grammar::Tick ticks_per_second);

Findings JudgeInvariants(const CheckedRun& checked);

Findings JudgeLaws(const CheckedRun& checked);
Findings JudgeLaws(const episode::SegmentedRecording& recording);

// A scenario after metamorphic transforms: the same events, boundaries within the tolerances of its
// golden. Tested by tests/harness/suite/judge/ensemble_test.cc and
// tests/witnesses/metamorphic/metamorphic_test.cc

/// What an ensemble found: the scenario as its file says, and once after each of kTransforms that
/// leaves its story the same. `here` is what the first play recognised.
struct Ensemble {
  int plays = 1;
  std::vector<truth::Spread>
      spreads;           ///< by index in Golden::events; of events that all plays have
  Findings broken;       ///< plays that fail, or whose events contradict what the scenario expects
  Findings differences;  ///< one per play whose events differ by more than the tolerances
  int plays_broken = 0;
};
Ensemble PlayEnsemble(const episode::LoadedRun& loaded, const grammar::Timeline& here,
                      const truth::Golden& golden);

/// Writes how far the boundaries moved into the lines of `golden`, for which it was played.
void KeepSpreads(const Ensemble& ensemble, truth::Golden& golden);

/// A scenario after a change that leaves its story the same.
struct TransformedScenario {
  std::string name;  ///< of the change
  scenario::Scenario scenario;
  /// Of boundaries without one of their own, in ticks of this scenario.
  grammar::Tick tolerance = 0;
  /// Gives events the names of the original, in a timeline that stays sorted; empty: they have
  /// them.
  std::function<void(grammar::Timeline&)> rename_back = {};
};

struct TransformedPlay {
  Findings failed;                              ///< to come to its end
  std::vector<truth::ClaimVerdict> claims;      ///< of what the scenario expects, here as there
  Findings differs;                             ///< from the golden
  std::optional<truth::Comparison> comparison;  ///< of a play that came to its end
};
/// Events of those who are not in the original are left out.
TransformedPlay Play(const TransformedScenario& there, const episode::LoadedRun& original,
                     const truth::Golden& here);

/// What is wrong with it whatever a golden says.
Findings BrokenIn(const TransformedPlay& play, const std::string& name);

// What a demonstration of a robot does with things and what goes wrong in it, from its events, its
// poses and its gripper: docs/robot-demonstrations.md, "Why did it fail". Tested by
// tests/program/failed_demonstrations.py

/// Something goes wrong, at a moment.
struct Mishap {
  grammar::Tick tick = 0;
  std::string what;      ///< "cube_3 missed, gripper closed on nothing"
  std::string object;    ///< that has to be taken again
  std::string question;  ///< options of `explain`
  bool is_miss = false;
};

/// A thing is grasped and put somewhere.
struct Handling {
  std::string event, hand, object;
  std::string support;  ///< what it rests on afterwards; or ""
  grammar::Tick begin = 0, end = 0;
  bool open_end = false;  ///< it is held to the end of the episode
};

struct Demonstration {
  std::optional<bool> success;  ///< as the file says
  grammar::Tick ticks_per_second = 1, end = 1;
  std::vector<Handling> handled;  ///< by begin; only the last time of several in a row
  std::vector<Mishap> mishaps;    ///< by tick
};

/// Nothing if no gripper ever closes in it, and nobody says that it failed. What grasps and
/// supports are say `drawings`.
std::optional<Demonstration> DemonstrationOf(episode::Recording& recording,
                                             const grammar::Timeline& timeline,
                                             const truth::EventDrawings& drawings);

/// Of each that failed, the first thing that went wrong and was not made good; compared with what
/// most of those do that succeeded.
std::vector<std::optional<Mishap>> FirstCauses(const std::vector<const Demonstration*>& all);

// The clauses of a grammar's rules as they are written, so that a changed one can be named and put
// back. Tested by tests/harness/suite/judge/clauses_test.cc

/// Of a rule, a condition, a law, a definition: "transporting(..)" has "transporting roles",
/// "transporting outside", "transporting drawn"; of a law "NAME law" is all that it demands. A
/// parameter is one by itself: "far" is "2 cm".
struct Clause {
  std::string name;  ///< of the rule, and the clause's first word; a second such clause: ".. 2"
  std::string text;  ///< without comments, one space where there were some
  std::size_t begin = 0, end = 0;  ///< in the file
};

/// In their order. A rule begins at the left margin; its clauses are indented as its first one is,
/// and go on where a line is indented further.
std::vector<Clause> ClausesOf(std::string_view grammar);

/// The file with this clause as it was: another text, none, or one again. "" without its rule.
std::string WithClause(std::string_view grammar, const std::string& name, const std::string& text);

/// "lost `putting_down(hand, object)`", "gained ..", "`>= 2 cm` -> `>= 5 cm`": what lies between
/// the words that both begin and end with.
std::string ClauseChangeText(std::string_view before, std::string_view after);

}  // namespace prehend::suite
