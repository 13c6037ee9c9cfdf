// SPDX-License-Identifier: Apache-2.0
// See harness/check/check_scenario.h. Tested by tests/program/command_line_test.cc
#include "harness/check/check_scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "harness/base/shell_quote.h"
#include "harness/check/accept_golden.h"
#include "harness/check/blame.h"
#include "harness/check/compare_engines.h"
#include "harness/check/difference_context.h"
#include "harness/check/invariants.h"
#include "harness/check/last_pass.h"
#include "harness/check/state_trace.h"
#include "harness/check/unreferenced_goldens.h"
#include "harness/golden/compare.h"
#include "harness/golden/golden_files.h"
#include "harness/golden/timeline_svg.h"
#include "harness/pictures/pictures.h"
#include "harness/run/run_scenario.h"
#include "harness/run/run_text.h"
#include "harness/sense/entity_table.h"
#include "harness/timeline/event_text.h"

namespace prehend::harness {
namespace {

namespace fs = std::filesystem;

/// The options of the command line that ask for these changes.
std::vector<std::string> OptionsOf(const RunRequest& changes) {
  std::vector<std::string> options;
  if (!changes.grammar.empty()) options.push_back("--grammar " + ShellQuoted(changes.grammar));
  for (const std::string& setting : changes.settings)
    options.push_back("--set " + ShellQuoted(setting));
  return options;
}

std::string ChangesText(const RunRequest& changes) {
  std::string text;
  for (const std::string& option : OptionsOf(changes)) text += " " + option;
  return text;
}

/// Lowers a verdict; the first reason found is the one that is told in one line.
void Fail(ScenarioVerdict& verdict, ExitCode code, const std::string& reason,
          const std::string& details = {}) {
  verdict.details += details;
  if (verdict.verdict == Verdict::kFailed) return;
  verdict.verdict = Verdict::kFailed;
  verdict.exit_code = code;
  verdict.reason = reason;
}

void Draw(const CheckRequest& request, const Scenario& scenario, const RunResult& run,
          ScenarioVerdict& verdict) {
  if (!request.pictures || !CanDrawPictures()) return;
  const fs::path folder = fs::path(request.report_folder) / "pictures" / scenario.skill;
  std::error_code error;
  fs::create_directories(folder, error);
  const PictureResult drawn = DrawPictures(scenario, run, folder.string());
  for (const WrittenPicture& picture : drawn.pictures) {
    const std::string file =
        fs::path(picture.file).lexically_relative(request.report_folder).generic_string();
    verdict.pictures.push_back({.file = file, .caption = picture.caption});
  }
  if (!drawn.error.empty())
    Fail(verdict, ExitCode::kFailure, "no picture", "no picture: " + drawn.error + "\n");
}

/// Whether it is played as its file says: what differs can be accepted, what is not asked for is
/// not.
bool AsItsFileSays(const CheckRequest& request) { return OptionsOf(request.run).empty(); }

/// Keeps a picture that differs, and where it does, for `review`. The lines that say where.
std::string LeavePicture(const CheckRequest& request, const std::string& golden,
                         const fs::path& drawn) {
  if (request.is_trial) return "";
  const GoldenFiles files(request.root);
  const std::string name = drawn.filename().string();
  const fs::path pending = files.PendingPicturePath(request.id, name);
  const std::string difference = files.DifferencePath(request.id, name).string();
  std::error_code ignored;
  files.RemovePendingPicture(request.id, name);
  fs::create_directories(pending.parent_path(), ignored);
  fs::copy_file(drawn, pending, ignored);
  return WritePictureDifference(golden, drawn.string(), difference)
             ? "  difference " + difference + "\n"
             : "";
}

/// Says what differs; MergeRepeats() decides what that means. Pictures that nobody asks for fail at
/// once.
void JudgePictures(const CheckRequest& request, const Scenario& scenario,
                   ScenarioVerdict& verdict) {
  if (!request.has_golden) return;
  const GoldenFiles files(request.root);
  const std::string accept =
      AsItsFileSays(request)
          ? fmt::format("  accept it with: prehend accept {} --pictures --reason \"...\"\n",
                        ShellQuoted(request.id))
          : "";
  for (const ReportedPicture& picture : verdict.pictures) {
    const fs::path drawn = fs::path(request.report_folder) / picture.file;
    const std::string name = drawn.filename().string();
    const std::string golden = files.PicturePath(request.id, name).string();
    std::error_code ignored;
    if (!fs::exists(golden, ignored)) continue;
    const std::string difference = PictureDifference(golden, drawn.string());
    if (difference.empty()) {
      if (!request.is_trial) files.RemovePendingPicture(request.id, name);
      continue;
    }
    verdict.picture_differences +=
        fmt::format("picture {}: {}\n  expected {}\n{}{}", drawn.string(), difference, golden,
                    LeavePicture(request, golden, drawn), accept);
  }
  if (!AsItsFileSays(request)) return;
  for (const fs::path& unasked :
       UnaskedPictures(request.id, scenario.pictures.size(), request.root)) {
    Fail(verdict, ExitCode::kDiffers, "a golden picture that the scenario does not ask for",
         UnaskedText(unasked, scenario.pictures.size()) + "\n  remove it, or: prehend accept " +
             ShellQuoted(request.id) + " --pictures --reason \"...\"\n");
  }
}

/// A rule's head is "event NAME(...)", or "symmetric event NAME(...)".
std::map<std::string, grammar::Wait> LatencyByEvent(const grammar::Program& program) {
  std::map<std::string, grammar::Wait> latency;
  for (const grammar::RuleDescription& rule : Describe(program).rules) {
    const std::string before_roles = rule.head.substr(0, rule.head.find('('));
    latency[before_roles.substr(before_roles.rfind(' ') + 1)] = rule.latency;
  }
  return latency;
}

void JudgeInvariants(const LoadedRun& loaded, const RunResult& run, ScenarioVerdict& verdict) {
  EpisodeFacts facts{.end = run.ticks + 1};
  facts.ticks_per_frame =
      DefaultTolerance(loaded.scenario.scene.world.rate_hz, loaded.scenario.sensing.sensing_hz) / 2;
  facts.latency = LatencyByEvent(*loaded.program);
  const Violations violations = CheckInvariants(run.timeline, facts);
  std::string details;
  for (const Violation& violation : violations) {
    details += "violated: " + Text(violation, run.timeline.ticks_per_second) + "\n";
  }
  if (!violations.empty()) Fail(verdict, ExitCode::kDiffers, "invariant violated", details);
}

/// The laws of the scenario's own grammar.
void JudgeLaws(const LoadedRun& loaded, const RunResult& run, ScenarioVerdict& verdict) {
  std::string details;
  for (const grammar::LawViolation& violation :
       CheckLaws(*loaded.program, MakeEntityTable(loaded.scenario), run.timeline))
    details += "violated: " + Text(violation, run.timeline.ticks_per_second) + "\n";
  if (!details.empty())
    Fail(verdict, ExitCode::kDiffers, "a law of the grammar is violated", details);
}

void LeavePending(const CheckRequest& request, const Golden& pending) {
  if (request.is_trial) return;
  // Whether it could be written is only news to `accept`, which runs the scenario itself.
  (void)GoldenFiles(request.root).WritePending(pending);
}

std::vector<BoundaryRoom> Boundaries(const Comparison& comparison) {
  std::vector<BoundaryRoom> boundaries;
  for (const Headroom& room : comparison.headroom) {
    boundaries.push_back({room.boundary, MillisecondsOf(room.offset, comparison.ticks_per_second),
                          MillisecondsOf(room.tolerance, comparison.ticks_per_second)});
  }
  return boundaries;
}

/// Remembers how a run that agreed moved, for the blame of later ones.
void LeaveTrace(const CheckRequest& request, const Scenario& scenario, const RunResult& run) {
  if (request.is_trial) return;
  // Losing it only costs the blame of the next difference its answer.
  (void)WriteTrace(CheckRecords(request.root).TracePath(request.id),
                   TraceOf(scenario.scene, run.recording));
}

std::string Blame(const CheckRequest& request, const Scenario& scenario, const RunResult& run,
                  const FileHashes& inputs) {
  const CheckRecords records(request.root);
  return BlameText(records.Read(request.id), ReadTrace(records.TracePath(request.id)),
                   {.program = request.program,
                    .inputs = inputs,
                    .options = OptionsOf(request.run),
                    .other_grammar = !request.run.grammar.empty(),
                    .trace = TraceOf(scenario.scene, run.recording),
                    .ticks_per_second = static_cast<double>(run.timeline.ticks_per_second)},
                   request.root);
}

/// There is nothing to compare with.
void JudgeWithoutGolden(const CheckRequest& request, const Golden& pending,
                        const std::string& differs_from_truth, ScenarioVerdict& verdict) {
  LeavePending(request, pending);
  verdict.details += differs_from_truth;
  if (verdict.verdict != Verdict::kPassed) return;
  verdict.verdict = Verdict::kPending;
  verdict.exit_code = ExitCode::kPending;
  verdict.reason =
      request.has_golden ? "no golden yet" : "no golden: only scenarios below scenarios/ have one";
}

/// What differs, with the facts around the first of it, and whose doing it is.
void TellDifferences(const CheckRequest& request, const LoadedRun& loaded, const RunResult& run,
                     const Comparison& comparison, ScenarioVerdict& verdict) {
  verdict.blame = Blame(request, loaded.scenario, run, verdict.inputs);
  const std::string facts =
      FactsAround(loaded.scenario, run.recording, *comparison.FirstDivergence());
  verdict.differences = DifferencesJson(comparison, ExplainCommand(request.id, request.run));
  verdict.relations = RelationsJson(comparison);
  const auto differing = std::ranges::count_if(comparison.pairings, [](const Pairing& pairing) {
    return pairing.agreement != LineVerdict::kMatched;
  });
  Fail(verdict, ExitCode::kDiffers,
       fmt::format("{} of {} events differ from the golden", differing, comparison.pairings.size()),
       DifferenceText(comparison, ExplainCommand(request.id, request.run), facts) + verdict.blame);
}

void JudgeAgainstGolden(const CheckRequest& request, const LoadedRun& loaded, const RunResult& run,
                        ScenarioVerdict& verdict) {
  const ReadResult<Golden> golden = request.has_golden
                                        ? GoldenFiles(request.root).ReadGoldenOf(request.id)
                                        : ReadResult<Golden>{};
  if (!golden.diagnostics.empty()) {
    return Fail(verdict, ExitCode::kBadInput, "the golden cannot be read",
                Format(golden.diagnostics));
  }
  const Comparison comparison = Compare(
      golden.value.value_or(Golden{.ticks_per_second = run.timeline.ticks_per_second}),
      run.timeline,
      DefaultTolerance(loaded.scenario.scene.world.rate_hz, loaded.scenario.sensing.sensing_hz));
  verdict.timeline_svg = TimelineSvg(comparison, run.ticks + 1, run.drawings);
  const OracleComparison truth = CompareWithOracle(loaded.scenario, *loaded.program, run);
  const Golden pending =
      PendingGolden(golden.value, run.timeline, request.id, loaded.scenario.grammar, truth);
  if (!golden.value) return JudgeWithoutGolden(request, pending, GroundTruthText(truth), verdict);
  const int accepted = AcceptedDiffering(golden.value->derived);
  const bool truth_is_accepted = truth.Differing() == accepted;
  verdict.headroom = HeadroomText(comparison);
  verdict.boundaries = Boundaries(comparison);
  if (comparison.Agrees() && truth_is_accepted)
    return GoldenFiles(request.root).RemovePending(request.id);
  LeavePending(request, pending);
  if (!comparison.Agrees()) TellDifferences(request, loaded, run, comparison, verdict);
  if (!truth_is_accepted) {
    Fail(verdict, ExitCode::kDiffers,
         DifferingText(truth.Differing()) +
             (accepted > 0 ? fmt::format(", the golden says {}", accepted) : ""),
         GroundTruthText(truth));
  }
}

std::vector<std::string> FilesOfGolden(const CheckRequest& request) {
  const GoldenFiles goldens(request.root);
  std::vector<std::string> files = {goldens.GoldenPath(request.id).string()};
  for (const KeptPicture& picture : goldens.PicturesOf(request.id))
    files.push_back(picture.path.string());
  return files;
}

/// The goldens of the pictures that a scenario asks for, and of one more, which nobody asks for;
/// whether they are there or not: one that appears changes the verdict.
void AddPictures(const CheckRequest& request, const Scenario& scenario,
                 std::vector<std::string>& files) {
  for (std::size_t i = 1; i <= scenario.pictures.size() + 1; ++i) {
    const std::string file = scenario.name + (i == 1 ? "" : "-" + std::to_string(i)) + ".png";
    files.push_back(GoldenFiles(request.root).PicturePath(request.id, file).string());
  }
}

/// A planar scenario has the same events in both engines. How they differ waits for `review`.
void JudgeOtherEngine(const CheckRequest& request, const LoadedRun& loaded, const RunResult& run,
                      ScenarioVerdict& verdict) {
  const auto compared = CompareEngines(loaded.scenario, loaded.program, run.timeline);
  const std::string text = compared ? EngineDifferenceText(loaded.scenario, *compared,
                                                           ExplainCommand(request.id, request.run))
                                    : "";
  // Whether it could be written is only news to `review`; `accept` plays both engines itself.
  if (!request.is_trial) (void)GoldenFiles(request.root).WriteEngineDifference(request.id, text);
  if (text.empty()) return;
  const std::string engine = NameOf(compared->other);
  if (compared->run.status.kind != physics::RunStatus::Kind::kCompleted)
    return Fail(verdict, ExitCode::kFailure, "the simulation failed in " + engine, text);
  Fail(verdict, ExitCode::kDiffers, engine + " does not lead to the same events",
       text + kUntilEnginesAgree + "\n");
}

}  // namespace

ScenarioVerdict CheckScenario(const CheckRequest& request) {
  ScenarioVerdict verdict{.scenario = request.id, .shows = {}, .verdict = Verdict::kPassed};
  verdict.command = RepeatCommand(request.id, request.run);
  std::vector<std::string> files =
      request.has_golden ? FilesOfGolden(request) : std::vector<std::string>();
  const ReadResult<LoadedRun> loaded = LoadRun(request.run, request.root, &files);
  if (loaded.value && request.has_golden) AddPictures(request, loaded.value->scenario, files);
  verdict.inputs = HashFiles(files);
  if (!loaded.value) {
    Fail(verdict, ExitCode::kBadInput, "cannot be read", Format(loaded.diagnostics));
    verdict.command = "prehend validate " + ShellQuoted(request.id) + ChangesText(request.run);
    return verdict;
  }
  const Scenario& scenario = loaded.value->scenario;
  verdict.shows = scenario.shows;

  RunOptions how{.record = true};
  if (request.last_tick)
    how.watch = [&](const grammar::Frame& frame) { request.last_tick->store(frame.tick); };
  const RunResult run = RunScenario(scenario, loaded.value->program, how);
  Draw(request, scenario, run, verdict);
  verdict.state_hash = HashText(run.state_hash);
  verdict.ticks = run.ticks;

  if (run.status.kind != physics::RunStatus::Kind::kCompleted) {
    Fail(verdict, ExitCode::kFailure, "the simulation failed", StatusText(run) + "\n");
    verdict.command = "prehend run " + ShellQuoted(request.id) + ChangesText(request.run);
    return verdict;
  }
  JudgeInvariants(*loaded.value, run, verdict);
  JudgeLaws(*loaded.value, run, verdict);
  JudgeAgainstGolden(request, *loaded.value, run, verdict);
  JudgeOtherEngine(request, *loaded.value, run, verdict);
  JudgePictures(request, scenario, verdict);
  if (verdict.verdict == Verdict::kPending && request.has_golden && AsItsFileSays(request))
    verdict.command = "prehend review " + ShellQuoted(request.id);
  if (verdict.verdict == Verdict::kPassed) LeaveTrace(request, scenario, run);
  return verdict;
}

std::string ExplainCommand(const std::string& id, const RunRequest& changes) {
  return "prehend explain " + ShellQuoted(id) + ChangesText(changes);
}

std::string RepeatCommand(const std::string& id, const RunRequest& changes) {
  return "prehend check " + ShellQuoted(id) + ChangesText(changes);
}

}  // namespace prehend::harness
