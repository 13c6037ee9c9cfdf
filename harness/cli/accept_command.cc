// SPDX-License-Identifier: Apache-2.0
// prehend accept: the only thing that writes goldens. It runs the scenario itself, so that what is
// accepted is what this build recognises now, and refuses when that is not what was shown.
// Tested by tests/program/golden_workflow_test.cc
#include <CLI/CLI.hpp>
#include <algorithm>

#include "harness/base/content_hash.h"
#include "harness/check/check_scenario.h"
#include "harness/check/last_pass.h"
#include "harness/check/state_trace.h"
#include "harness/cli/accept_pictures.h"
#include "harness/cli/command.h"
#include "harness/golden/compare.h"
#include "harness/golden/golden_files.h"
#include "harness/judge/accept_golden.h"
#include "harness/judge/compare_engines.h"
#include "harness/judge/compare_with_oracle.h"
#include "harness/run/run_text.h"

namespace prehend::harness {
namespace {

constexpr std::size_t kFingerprintDigits = 16;

void Declare(CLI::App& options) {
  options.add_option("scenario", "a name or skill/name")->required()->expected(1);
  options.add_option("--reason", "why this is right; stays in the golden")
      ->type_name("TEXT")
      ->expected(1);
  options
      .add_option("--derived",
                  "how it follows from the definitions, one line each; what the physical oracle "
                  "says is added")
      ->type_name("TEXT")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  options.add_option("--reviewed", "what 'prehend review' printed: accept that, and nothing else")
      ->type_name("FINGERPRINT")
      ->expected(1);
  DeclareFlag(options, "--pictures",
              "its pictures become goldens, kept beside the timeline; the events stay as they are");
}

/// "" or that it is none.
std::string NoFingerprint(const std::string& typed) {
  const bool is_one = typed.size() == kFingerprintDigits &&
                      typed.find_first_not_of("0123456789abcdef") == std::string::npos;
  if (is_one) return "";
  return "--reviewed: '" + typed +
         "' is no fingerprint; 'prehend review' prints it, 16 digits from 0-9 and a-f, like "
         "3fa90c11d27e5b60";
}

/// "" or why the command line alone is enough to refuse.
std::string Refusal(const CLI::App& options, const CommandContext& context) {
  if (context.in_ci) return "nothing is accepted where CI is set: a golden is a person's decision";
  if (ValueOf(options, "--reason").find_first_not_of(" \t") == std::string::npos) {
    return "accepting needs a reason: --reason \"why this is right\"";
  }
  for (const char* name : {"--derived", "--reviewed"}) {
    if (IsGiven(options, "--pictures") && IsGiven(options, name))
      return std::string(name) + " is about events, and --pictures accepts pictures only";
  }
  for (const char* name : {"--reason", "--derived"}) {
    for (const std::string& text : ValuesOf(options, name)) {
      if (text.find_first_of("\n\r") != std::string::npos)
        return std::string(name) + " takes a single line";
    }
  }
  return IsGiven(options, "--reviewed") ? NoFingerprint(ValueOf(options, "--reviewed")) : "";
}

/// What was played, and the golden it had before.
struct Played {
  std::string id;
  std::optional<Golden> old;
  LoadedRun loaded;
  std::vector<std::string> files;  ///< all that decided it
  RunResult run;
};

/// What will change, before it does, and where it differs from the ground truth.
void ShowDifference(const Played& played, const OracleComparison& truth,
                    const CommandContext& context) {
  if (!played.old) {
    context.out << "new golden:\n" << RunTable(played.run);
  } else {
    const WorldYaml& world = played.loaded.scenario.world;
    context.out << DifferenceText(Compare(*played.old, played.run.timeline,
                                          DefaultTolerance(world.rate_hz, world.sensing_hz)),
                                  ExplainCommand(played.id, {}));
  }
  context.out << GroundTruthText(truth);
}

/// The next blame compares with what was accepted now.
void LeaveBaseline(const CommandContext& context, const Played& played) {
  const CheckRecords records(context.root);
  CheckRecord record{.program = ProgramHash(), .passed = false, .pictures = false, .verdict = {}};
  record.verdict.scenario = played.id;
  record.verdict.inputs = HashFiles(played.files);
  // Losing it only costs the blame of the next difference its answer.
  (void)records.Write(record);
  (void)WriteTrace(records.TracePath(played.id),
                   TraceOf(played.loaded.scenario.scene, played.run.recording));
}

/// "" or why it is not what a person was shown: by the fingerprint, or by the file that waits.
std::string NotWhatWasShown(const CLI::App& options, const CommandContext& context,
                            const Golden& pending) {
  const std::string now = Fingerprint(pending);
  const ReadResult<Golden> waiting = GoldenFiles(context.root).ReadPendingOf(pending.scenario);
  const std::string shown = waiting.value ? Fingerprint(*waiting.value) : now;
  const std::string reviewed =
      IsGiven(options, "--reviewed") ? ValueOf(options, "--reviewed") : shown;
  if (reviewed == now) return "";
  if (reviewed == shown)
    return "what waited for acceptance was " + shown +
           ", but the scenario yields something else now, " + now;
  if (shown == now) return "what waits for acceptance is " + now + ", not " + reviewed;
  return "what was reviewed was " + reviewed + ", but the scenario yields something else now, " +
         now;
}

/// Shows what is there now instead, and lets it wait for the next acceptance.
ExitCode Refuse(const CommandContext& context, const Played& played, const Golden& pending,
                const OracleComparison& truth, const std::string& why) {
  ShowDifference(played, truth, context);
  const std::string problem = GoldenFiles(context.root).WritePending(pending);
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  return Complain(context, ExitCode::kDiffers,
                  why + " (shown above); nothing was accepted\n  if that is right: " +
                      AcceptCommandLine(played.id, Fingerprint(pending)));
}

ExitCode NothingToAccept(const CommandContext& context, const Played& played) {
  GoldenFiles(context.root).RemovePending(played.id);
  LeaveBaseline(context, played);
  const WorldYaml& world = played.loaded.scenario.world;
  const std::string margin = MarginText(
      Compare(*played.old, played.run.timeline, DefaultTolerance(world.rate_hz, world.sensing_hz)));
  context.out << "nothing to accept: the scenario agrees with "
              << GoldenFiles(context.root).GoldenPath(played.id).string()
              << (margin.empty() ? "" : "; " + margin) << "\n";
  return ExitCode::kAgrees;
}

/// Whatever were accepted, `check` would fail: a planar scenario has the same events in both
/// engines.
std::optional<ExitCode> RefuseUnlessEnginesAgree(const CommandContext& context,
                                                 const Played& played) {
  const auto compared =
      CompareEngines(played.loaded.scenario, played.loaded.program, played.run.timeline);
  const std::string text = compared ? EngineDifferenceText(played.loaded.scenario, *compared,
                                                           ExplainCommand(played.id, {}))
                                    : "";
  (void)GoldenFiles(context.root).WriteEngineDifference(played.id, text);
  if (text.empty()) return std::nullopt;
  context.out << text;
  const bool ended = compared->run.status.kind == physics::RunStatus::Kind::kCompleted;
  return Complain(context, ended ? ExitCode::kDiffers : ExitCode::kFailure,
                  std::string(NameOf(compared->other)) +
                      " does not lead to the same events (shown above); nothing was accepted\n  " +
                      kUntilEnginesAgree);
}

ExitCode AcceptEvents(const CLI::App& options, const CommandContext& context,
                      const Played& played) {
  const auto& [id, old, loaded, inputs, run] = played;
  const GoldenFiles files(context.root);
  const OracleComparison truth = CompareWithOracle(loaded.scenario, *loaded.program, run);
  Proposal proposal{.scenario = id,
                    .grammar = loaded.scenario.grammar,
                    .derived = ValuesOf(options, "--derived"),
                    .acceptance = Acceptance{context.today, ValueOf(options, "--reason")},
                    .tolerance = truth.tolerance};
  const bool from_people = !proposal.derived.empty();
  if (!from_people && old) proposal.derived = old->derived;
  proposal.derived = RenewedDerivation(proposal.derived, OracleLine(truth));
  const bool tells_derivation = from_people && (!old || old->derived != proposal.derived);
  const Golden pending = PendingGolden(old, run.timeline, id, loaded.scenario.grammar, truth);
  if (old && *old == pending && !tells_derivation) return NothingToAccept(context, played);
  const std::string why_not = NotWhatWasShown(options, context, pending);
  if (!why_not.empty()) return Refuse(context, played, pending, truth, why_not);
  ShowDifference(played, truth, context);
  context.out << OracleLine(truth) << "\n";
  const std::string problem = files.WriteAccepted(ProposeGolden(old, run.timeline, proposal));
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  LeaveBaseline(context, played);
  context.out << "accepted: " << files.GoldenPath(id).string() << "\n";
  return ExitCode::kAgrees;
}

ExitCode Run(const CLI::App& options, const CommandContext& context) {
  const std::string refusal = Refusal(options, context);
  if (!refusal.empty()) return Complain(context, ExitCode::kBadInput, refusal);
  const std::string typed = ValueOf(options, "scenario");
  if (typed.find_first_of("*?[") != std::string::npos)
    return Complain(
        context, ExitCode::kBadInput,
        "'" + typed + "' may mean several scenarios; goldens are accepted one by one, by name");
  const auto file = FindScenarioOrComplain(typed, context);
  if (!file) return ExitCode::kNothing;
  if (!file->in_project) {
    return Complain(context, ExitCode::kBadInput,
                    "goldens are kept of scenarios in scenarios/ only; put the file there and "
                    "accept it by name");
  }
  Played played;
  played.id = ScenarioId(file->skill, file->name);
  played.files = {GoldenFiles(context.root).GoldenPath(played.id).string()};
  ReadResult<LoadedRun> loaded =
      LoadRun({.scenario_file = file->path}, context.root, &played.files);
  if (!loaded.value) return Complain(context, loaded.diagnostics);
  played.loaded = std::move(*loaded.value);
  ReadResult<Golden> old = GoldenFiles(context.root).ReadGoldenOf(played.id);
  if (!old.diagnostics.empty()) return Complain(context, old.diagnostics);
  played.old = std::move(old.value);
  if (IsGiven(options, "--pictures") && !played.old) {
    return Complain(context, ExitCode::kPending,
                    "its events have no golden yet; accept them first, without --pictures");
  }

  played.run = RunScenario(played.loaded.scenario, played.loaded.program, {.record = true});
  if (played.run.status.kind != physics::RunStatus::Kind::kCompleted) {
    return Complain(context, ExitCode::kFailure,
                    "a run that did not complete is not accepted: " + StatusText(played.run));
  }
  if (!IsGiven(options, "--pictures")) {
    if (const auto refused = RefuseUnlessEnginesAgree(context, played)) return *refused;
    return AcceptEvents(options, context, played);
  }
  return AcceptPictures(context, ValueOf(options, "--reason"), *played.old, played.loaded.scenario,
                        played.run);
}

}  // namespace

Command AcceptCommand() {
  return {
      .name = "accept",
      .summary = "Make what a scenario yields now its golden, with a reason",
      .examples =
          "prehend accept milk_carton_wrap --reason \"first golden, checked against the picture\"\n"
          "prehend accept milk_carton_wrap --reviewed 3fa90c11d27e5b60 --reason \"the grasp ends "
          "earlier\"\n"
          "prehend accept milk_carton_wrap --reason \"...\" --derived \"the reach begins with the "
          "hand's first motion\"\n"
          "prehend accept milk_carton_wrap --pictures --reason \"the carton is seen in the hand\"",
      .declare = Declare,
      .run = Run};
}

}  // namespace prehend::harness
