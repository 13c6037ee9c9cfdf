// SPDX-License-Identifier: Apache-2.0
// prehend accept: the only thing that writes goldens. It runs the scenario itself, so that what is
// accepted is what this build recognises now, and refuses when that is not what was shown.
// Tested by tests/program/golden_workflow_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/build_text.h"
#include "harness/base/base/content_hash.h"
#include "harness/base/base/shell_quote.h"
#include "harness/cli/command/command.h"
#include "harness/cli/daily/accept_pictures.h"
#include "harness/episode/episode/lacks.h"
#include "harness/episode/run/run_text.h"
#include "harness/suite/check/check_scenario.h"
#include "harness/suite/check/last_pass.h"
#include "harness/suite/check/state_trace.h"
#include "harness/suite/judge/accept_golden.h"
#include "harness/suite/judge/compare_engines.h"
#include "harness/suite/judge/compare_with_oracle.h"
#include "harness/suite/judge/ensemble.h"
#include "harness/suite/judge/judge_claims.h"
#include "harness/suite/judge/judge_recording.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/golden/golden_files.h"

namespace prehend::cli {
namespace {

constexpr std::size_t kFingerprintDigits = 16;

/// What is wrong with a fingerprint, or "".
std::string FingerprintProblem(const std::string& typed) {
  if (typed.size() == kFingerprintDigits &&
      typed.find_first_not_of("0123456789abcdef") == std::string::npos)
    return "";
  return "found '" + typed + "', wanted the 16 digits from 0-9 and a-f that '" +
         CommandText({"review"}) + "' prints, like 3fa90c11d27e5b60";
}

/// Why the command line alone is enough to refuse, or "".
std::string Refusal(const ParsedOptions& options, const CommandContext& context) {
  if (context.in_ci) return "accept is disabled where CI is set: a golden is a person's decision";
  if (options.Text("--reason").find_first_not_of(" \t") == std::string::npos) {
    return "accept needs a reason: --reason \"why this is right\"";
  }
  for (const char* name : {"--derived", "--reviewed", "--unsteady", "--exact"}) {
    if (options.Has("--pictures") && options.Has(name))
      return std::string(name) + " concerns events; --pictures accepts pictures only";
  }
  for (const char* name : {"--reason", "--derived", "--unsteady"}) {
    for (const std::string& text : options.All(name)) {
      if (text.find_first_of("\n\r") != std::string::npos)
        return std::string(name) + " must be a single line";
    }
  }
  return "";
}

/// A finished run, and the golden that the scenario had before.
struct Played {
  std::string id;
  std::optional<truth::Golden> old;
  episode::LoadedRun loaded;
  std::vector<std::string> files;  ///< all that the run depends on
  episode::RunResult run;
};

/// Prints what will change, and where it differs from the ground truth.
void ShowDifference(const Played& played, const suite::OracleComparison& truth,
                    const CommandContext& context) {
  if (!played.old) {
    context.out << "new golden:\n" << episode::RunTable(played.run);
  } else {
    context.out << truth::DifferenceText(
        truth::Compare(*played.old, played.run.timeline,
                       scenario::DefaultTolerance(played.loaded.scenario)),
        suite::CommandAbout("explain", played.id));
  }
  context.out << suite::GroundTruthText(truth);
}

/// A line for each event whose boundaries moved within their tolerance, or "".
std::string MovedWithinTolerance(const Played& played) {
  const double ms = 1000.0 / static_cast<double>(played.old->ticks_per_second);
  std::string text;
  for (const truth::Pairing& pairing :
       truth::Compare(*played.old, played.run.timeline,
                      scenario::DefaultTolerance(played.loaded.scenario))
           .pairings) {
    if (pairing.agreement != truth::LineVerdict::kMatched) continue;
    if (pairing.begin_offset == 0 && pairing.end_offset == 0) continue;
    text += fmt::format("moved {}: begin {:+.1f} ms, end {:+.1f} ms, within the tolerance\n",
                        pairing.event().Label(), static_cast<double>(pairing.begin_offset) * ms,
                        static_cast<double>(pairing.end_offset) * ms);
  }
  return text;
}

/// The next difference is traced back to the run that is accepted now.
void LeaveBaseline(const CommandContext& context, const Played& played) {
  const suite::LastPasses records(context.root);
  suite::LastPass record{.program = ProgramHash(),
                         .build = BuildText(),
                         .passed = false,
                         .pictures = false,
                         .verdict = {}};
  record.verdict.scenario = played.id;
  record.verdict.inputs = HashFiles(played.files);
  record.verdict.settings =
      suite::SettingsOf(played.loaded, {}, record.verdict.inputs, context.root);
  // Without it, only the cause of the next difference stays unknown.
  (void)records.Write(record);
  (void)suite::WriteTrace(records.TracePath(played.id),
                          suite::TraceOf(played.loaded.scenario.scene, played.run.recording));
}

/// Why `pending` is not what a person was shown (by the fingerprint, or by the pending file), or
/// "".
std::string NotWhatWasShown(const ParsedOptions& options, const CommandContext& context,
                            const truth::Golden& pending) {
  const std::string now = suite::Fingerprint(pending);
  const auto waiting = truth::GoldenFiles(context.root).ReadPendingOf(pending.scenario);
  const std::string shown = waiting && *waiting ? suite::Fingerprint(**waiting) : now;
  const std::string reviewed = options.Has("--reviewed") ? options.Text("--reviewed") : shown;
  if (reviewed == now) return "";
  if (reviewed == shown)
    return "the pending golden is " + shown + ", but the scenario now yields " + now;
  if (shown == now) return "the pending golden is " + now + ", not " + reviewed;
  return "the reviewed golden was " + reviewed + ", but the scenario now yields " + now;
}

/// Prints the difference and leaves it as the pending golden.
ExitCode Refuse(const CommandContext& context, const Played& played, const truth::Golden& pending,
                const suite::OracleComparison& truth, const std::string& why) {
  ShowDifference(played, truth, context);
  const std::string problem = truth::GoldenFiles(context.root).WritePending(pending);
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  return Complain(context, ExitCode::kDiffers,
                  why + " (printed above); nothing was accepted\n  if that is right: " +
                      suite::AcceptCommandLine(played.id, suite::Fingerprint(pending)));
}

/// Events that are others a millimetre away prove nothing, unless a person says why they may be.
/// Otherwise keeps how far the boundaries of `golden` moved.
std::optional<ExitCode> RefuseUnlessSteady(const CommandContext& context, const Played& played,
                                           truth::Golden& golden) {
  const suite::Ensemble ensemble = suite::PlayEnsemble(played.loaded, played.run.timeline, golden);
  if (!ensemble.broken.empty()) {
    for (const suite::Finding& broken : ensemble.broken) context.out << broken.details;
    return Complain(
        context, ExitCode::kDiffers,
        fmt::format("what the scenario expects does not hold after {} of {} transforms (printed "
                    "above); nothing was accepted\n  ",
                    ensemble.plays_broken, ensemble.plays - 1) +
            suite::kUntilClaimsHold);
  }
  suite::KeepSpreads(ensemble, golden);
  if (ensemble.differences.empty() && !golden.unsteady.empty()) {
    context.out << fmt::format("steady in {} plays: 'unsteady' is left out\n", ensemble.plays);
    golden.unsteady.clear();
  }
  if (ensemble.differences.empty() || !golden.unsteady.empty()) return std::nullopt;
  for (const suite::Finding& difference : ensemble.differences) context.out << difference.details;
  return Complain(
      context, ExitCode::kDiffers,
      fmt::format("the events are others after {} of {} transforms (printed above); nothing was "
                  "accepted\n  give the scenario a margin{}, or say why that may be: --unsteady "
                  "\"...\"",
                  ensemble.differences.size(), ensemble.plays - 1,
                  played.old ? ", or its line in the golden a tolerance with a reason" : ""));
}

/// Of a golden that stays as it is otherwise. The code if that fails.
std::optional<ExitCode> MeasureSpreadsAnew(const CommandContext& context, const Played& played) {
  truth::Golden golden = *played.old;
  if (const auto refused = RefuseUnlessSteady(context, played, golden)) return refused;
  if (truth::WriteGolden(golden) == truth::WriteGolden(*played.old)) return std::nullopt;
  const std::string problem = truth::GoldenFiles(context.root).WriteAccepted(golden);
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  context.out << "how far transforms move boundaries was measured anew\n";
  return std::nullopt;
}

ExitCode NothingToAccept(const CommandContext& context, const Played& played) {
  truth::GoldenFiles(context.root).RemovePending(played.id);
  if (const auto refused = MeasureSpreadsAnew(context, played)) return *refused;
  LeaveBaseline(context, played);
  const std::string margin = MarginText(truth::Compare(
      *played.old, played.run.timeline, scenario::DefaultTolerance(played.loaded.scenario)));
  context.out << "nothing to accept: the scenario agrees with "
              << truth::GoldenFiles(context.root).GoldenPath(played.id).string()
              << (margin.empty() ? "" : "; " + margin) << "\n";
  return ExitCode::kAgrees;
}

/// What a scenario shows is decided before its events are.
std::optional<ExitCode> RefuseUnlessClaimsHold(const CommandContext& context,
                                               const Played& played) {
  const std::string text =
      truth::TextOfContradicted(suite::JudgeClaims(played.loaded, played.run.timeline));
  if (text.empty()) return std::nullopt;
  context.out << text;
  return Complain(context, ExitCode::kDiffers,
                  std::string("the events contradict what the scenario expects (printed above); "
                              "nothing was accepted\n  ") +
                      suite::kUntilClaimsHold);
}

/// A planar scenario must have the same events in both engines: `check` would fail whatever were
/// accepted.
std::optional<ExitCode> RefuseUnlessEnginesAgree(const CommandContext& context,
                                                 const Played& played) {
  const auto compared =
      suite::CompareEngines(played.loaded.scenario, played.loaded.program, played.run.timeline);
  const std::string text =
      compared ? suite::EngineDifferenceText(played.loaded.scenario, *compared,
                                             suite::CommandAbout("explain", played.id))
               : "";
  (void)truth::GoldenFiles(context.root).WriteEngineDifference(played.id, text);
  if (text.empty()) return std::nullopt;
  context.out << text;
  const bool ended = compared->run.status.kind == physics::RunStatus::Kind::kCompleted;
  return Complain(context, ended ? ExitCode::kDiffers : ExitCode::kFailure,
                  std::string(suite::NameOf(compared->other)) +
                      " yields other events (printed above); nothing was accepted\n  " +
                      suite::kUntilEnginesAgree);
}

ExitCode AcceptEvents(const ParsedOptions& options, const CommandContext& context,
                      const Played& played) {
  const auto& [id, old, loaded, inputs, run] = played;
  const truth::GoldenFiles files(context.root);
  const suite::OracleComparison truth =
      suite::CompareWithOracle(loaded.scenario, *loaded.program, run);
  suite::Proposal proposal{.scenario = id,
                           .grammar = loaded.scenario.grammar,
                           .derived = options.All("--derived"),
                           .acceptance = truth::Acceptance{context.today, options.Text("--reason")},
                           .tolerance = truth.tolerance,
                           .exact = options.Has("--exact")};
  const bool from_people = !proposal.derived.empty();
  if (!from_people && old) proposal.derived = old->derived;
  proposal.derived = suite::RenewedDerivation(proposal.derived, suite::OracleLine(truth));
  const bool has_new_derivation = from_people && (!old || old->derived != proposal.derived);
  const truth::Golden pending =
      suite::PendingGolden(old, run.timeline, id, loaded.scenario.grammar, truth);
  const std::string moved = proposal.exact && old ? MovedWithinTolerance(played) : "";
  if (old && *old == pending && !has_new_derivation && !options.Has("--unsteady") && moved.empty())
    return NothingToAccept(context, played);
  const std::string why_not = NotWhatWasShown(options, context, pending);
  if (!why_not.empty()) return Refuse(context, played, pending, truth, why_not);
  truth::Golden golden = suite::ProposeGolden(old, run.timeline, proposal);
  if (options.Has("--unsteady")) golden.unsteady = options.Text("--unsteady");
  if (const auto refused = RefuseUnlessSteady(context, played, golden)) return *refused;
  ShowDifference(played, truth, context);
  context.out << moved << suite::OracleLine(truth) << "\n";
  const std::string problem = files.WriteAccepted(golden);
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  LeaveBaseline(context, played);
  context.out << "accepted: " << files.GoldenPath(id).string() << "\n";
  return ExitCode::kAgrees;
}

/// The golden of a recording lies beside it; nothing is simulated, so nothing is transformed.
ExitCode AcceptRecording(const std::string& file, const ParsedOptions& options,
                         const CommandContext& context) {
  for (const char* of_play : {"--pictures", "--unsteady", "--exact"}) {
    if (options.Has(of_play))
      return Complain(context, ExitCode::kBadInput,
                      fmt::format("{} concerns scenarios; {} is a recording", of_play, file));
  }
  const FolderLock one_at_a_time(context.root);
  const episode::RunRequest request{
      .scenario_file = file, .grammar = options.Text("--grammar"), .settings = {}};
  const Result<suite::JudgedRecording> judged = suite::JudgeRecording(request, context.root);
  if (!judged) return Complain(context, judged.error());
  const episode::SegmentedRecording& segmented = judged->segmented;
  context.err << segmented.missing.warnings;
  if (segmented.missing.nothing_left)
    return Complain(context, ExitCode::kNothing,
                    "no event of the grammar can be recognised; nothing was accepted");
  const std::string now = suite::Fingerprint(judged->proposed),
                    golden_file = suite::GoldenBeside(file);
  if (options.Has("--reviewed") && options.Text("--reviewed") != now)
    return Complain(context, ExitCode::kDiffers,
                    fmt::format("the reviewed golden was {}, but the recording now yields {}; "
                                "nothing was accepted\n  if that is right: {}",
                                options.Text("--reviewed"), now,
                                suite::AcceptCommandLine(file, now, request.grammar)));
  if (judged->Agrees() && !options.Has("--derived")) {
    context.out << "nothing to accept: the recording agrees with " << golden_file << "\n";
    return ExitCode::kAgrees;
  }
  const truth::Golden golden = suite::AcceptedRecording(*judged, options.All("--derived"),
                                                        {context.today, options.Text("--reason")});
  const std::string problem = truth::WriteGoldenFile(golden_file, golden);
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  context.out << suite::ReviewText(
                     *judged,
                     suite::CommandAbout("explain", file, {request.grammar, request.settings}))
              << "accepted: " << golden_file << "\n";
  return ExitCode::kAgrees;
}

/// One of the project: its events or its pictures.
ExitCode AcceptScenario(const episode::ScenarioFile& file, const ParsedOptions& options,
                        const CommandContext& context) {
  // Another one must not lose the reason that this one adds.
  const FolderLock one_at_a_time(context.root);
  Played played;
  played.id = episode::ScenarioId(file.skill, file.name);
  played.files = {truth::GoldenFiles(context.root).GoldenPath(played.id).string()};
  Result<episode::LoadedRun> loaded =
      episode::LoadRun({.scenario_file = file.path}, context.root, &played.files);
  if (!loaded) return Complain(context, loaded.error());
  played.loaded = std::move(*loaded);
  auto old = truth::GoldenFiles(context.root).ReadGoldenOf(played.id);
  if (!old) return Complain(context, old.error());
  played.old = std::move(*old);
  if (options.Has("--pictures") && !played.old) {
    return Complain(
        context, ExitCode::kPending,
        "the events of this scenario have no golden yet; accept them first, without --pictures");
  }

  played.run =
      episode::RunScenario(played.loaded.scenario, played.loaded.program, {.record = true});
  if (played.run.status.kind != physics::RunStatus::Kind::kCompleted) {
    return Complain(
        context, ExitCode::kFailure,
        "a run that did not complete cannot be accepted: " + episode::StatusText(played.run));
  }
  if (!options.Has("--pictures")) {
    for (const std::string& note : episode::NoteLines(played.loaded.scenario, played.run))
      context.err << note << "\n";
    if (const auto refused = RefuseUnlessClaimsHold(context, played)) return *refused;
    if (const auto refused = RefuseUnlessEnginesAgree(context, played)) return *refused;
    return AcceptEvents(options, context, played);
  }
  return AcceptPictures(context, options.Text("--reason"), *played.old, played.loaded.scenario,
                        played.run);
}

ExitCode RunAccept(const ParsedOptions& options, const CommandContext& context) {
  const std::string refusal = Refusal(options, context);
  if (!refusal.empty()) return Complain(context, ExitCode::kBadInput, refusal);
  const std::string typed = options.Text("scenario");
  std::error_code error;
  if (episode::EpisodeKindOf(typed) == episode::EpisodeKind::kJsonLines &&
      std::filesystem::exists(typed, error))
    return AcceptRecording(typed, options, context);
  if (episode::EpisodeKindOf(typed) == episode::EpisodeKind::kEpisodeFile) {
    const auto kept = episode::FindEpisodes({&typed, 1}, "", context.root);
    return kept ? Complain(context, ExitCode::kBadInput,
                           episode::Lack(*kept, episode::Need::kGolden))
                : Complain(context, kept.error());
  }
  if (options.Has("--grammar"))
    return Complain(
        context, ExitCode::kBadInput,
        "--grammar concerns recordings; the golden of a scenario is of the grammar that "
        "it names");
  if (typed.find_first_of("*?[") != std::string::npos)
    return Complain(
        context, ExitCode::kBadInput,
        "'" + typed +
            "' may match several scenarios; accept takes one scenario at a time, by name");
  const auto file = FindScenarioOrComplain(typed, context);
  if (!file) return file.error();
  if (!file->in_project) {
    return Complain(context, ExitCode::kBadInput,
                    "only scenarios in scenarios/ have goldens; move the file there and accept it "
                    "by name");
  }
  return AcceptScenario(*file, options, context);
}

}  // namespace

Command AcceptCommand() {
  return {
      .name = "accept",
      .summary = "Make what a scenario yields now its golden, with a reason",
      .examples =
          {"accept milk_carton_wrap --reason \"first golden, checked against the picture\"",
           "accept milk_carton_wrap --reviewed 3fa90c11d27e5b60 --reason \"the grasp ends "
           "earlier\"",
           "accept milk_carton_wrap --reason \"...\" --derived \"the reach begins with the hand's "
           "motion\"",
           "accept milk_carton_wrap --pictures --reason \"the carton is seen in the hand\"",
           "accept takes/take1.jsonl --reason \"compared with the video\"",
           "accept takes/take1.jsonl --grammar my.grammar --reason \"compared with the video\""},
      .options = {{.name = "scenario",
                   .help = "a name, skill/name, or the file of a recording of a tracker",
                   .required = true},
                  {.name = "--reason",
                   .help = "why this is right; is written into the golden",
                   .placeholder = "TEXT"},
                  {.name = "--derived",
                   .help = "how the events follow from the definitions, one line each; the "
                           "physical oracle's derivation is added; may be repeated",
                   .placeholder = "TEXT",
                   .repeatable = true},
                  {.name = "--reviewed",
                   .help = "accept only what 'review' printed with this fingerprint",
                   .placeholder = "FINGERPRINT",
                   .rule = {.problem = FingerprintProblem}},
                  {.name = "--grammar",
                   .help =
                       "of a recording of a tracker: this grammar instead of the one that it names",
                   .placeholder = "NAME|FILE"},
                  {.name = "--exact",
                   .help = "take over boundaries that moved within their tolerance, too: after a "
                           "change that moved many, or the next small one fails"},
                  {.name = "--unsteady",
                   .help = "why the events may differ after a metamorphic transform, which "
                           "accept does; is written into the golden; without it they may not",
                   .placeholder = "TEXT"},
                  {.name = "--pictures",
                   .help =
                       "accept the pictures, not the events; they are kept beside the timeline"}},
      .run = RunAccept};
}

}  // namespace prehend::cli
