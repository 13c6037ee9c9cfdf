// SPDX-License-Identifier: Apache-2.0
// prehend accept: the only thing that writes goldens. It runs the scenario itself, so that what is
// accepted is what this build recognises now, and refuses when that is not what was shown.
// Tested by tests/house/golden_workflow_test.cc
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "harness/accept_golden.h"
#include "harness/check_records.h"
#include "harness/check_scenario.h"
#include "harness/commands/command.h"
#include "harness/compare.h"
#include "harness/content_hash.h"
#include "harness/derivation.h"
#include "harness/golden_files.h"
#include "harness/physics_trace.h"
#include "harness/pictures.h"
#include "harness/run_output.h"

namespace prehend::harness {
namespace {

namespace fs = std::filesystem;

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
  return "";
}

/// What will change, before it does.
void ShowDifference(const std::optional<Golden>& old, const Scenario& scenario,
                    const RunResult& run, const std::string& id, const CommandContext& context) {
  if (!old) {
    context.out << "new golden:\n" << RunTable(run);
    return;
  }
  const Comparison comparison = Compare(
      *old, run.timeline, DefaultTolerance(scenario.world.rate_hz, scenario.world.sensing_hz));
  const std::string text = DifferenceText(comparison, ExplainCommand(id, {}));
  context.out << (text.empty() ? "differs within tolerance only\n" : text);
}

/// Draws the pictures and moves those that are not as their goldens, to the byte, into their place.
/// How many these were; nothing after a complaint.
std::optional<int> ReplacePictures(const CommandContext& context, const std::string& id,
                                   const Scenario& scenario, const RunResult& run) {
  const fs::path folder = fs::path(context.root) / "build/pending-pictures" / scenario.skill;
  std::error_code error;
  fs::create_directories(folder, error);
  const PictureResult drawn = DrawPictures(scenario, run, folder.string());
  if (!drawn.error.empty()) {
    Complain(context, ExitCode::kFailure, "no picture: " + drawn.error);
    return std::nullopt;
  }
  int changed = 0;
  for (const WrittenPicture& picture : drawn.pictures) {
    const fs::path golden =
        GoldenFiles(context.root).PicturePath(id, fs::path(picture.file).filename().string());
    if (FileHash(golden.string()) == FileHash(picture.file)) continue;
    fs::create_directories(golden.parent_path(), error);
    fs::rename(picture.file, golden, error);
    if (error) {
      Complain(context, ExitCode::kFailure, "cannot write " + golden.string());
      return std::nullopt;
    }
    context.out << "accepted: " << golden.string() << "\n";
    ++changed;
  }
  return changed;
}

/// The events stay as they are; the reason goes into the header.
ExitCode AcceptPictures(const CLI::App& options, const CommandContext& context, Golden golden,
                        const Scenario& scenario, const RunResult& run) {
  const auto changed = ReplacePictures(context, golden.scenario, scenario, run);
  if (!changed) return ExitCode::kFailure;
  if (*changed == 0) {
    context.out << "nothing to accept: the pictures of " << golden.scenario
                << " are the same already\n";
    return ExitCode::kAgrees;
  }
  golden.pictures.push_back({context.today, ValueOf(options, "--reason")});
  const std::string problem = GoldenFiles(context.root).WriteGoldenFile(golden);
  return problem.empty() ? ExitCode::kAgrees : Complain(context, ExitCode::kFailure, problem);
}

/// What was played, and the golden it had before.
struct Played {
  std::string id;
  std::optional<Golden> old;
  PreparedRun prepared;
  std::vector<std::string> files;  ///< all that decided it
  RunResult run;
};

/// The next blame compares with what was accepted now.
void LeaveBaseline(const CommandContext& context, const Played& played) {
  const CheckRecords records(context.root);
  CheckRecord record{.program = ProgramHash(), .passed = false, .pictures = false, .verdict = {}};
  record.verdict.scenario = played.id;
  record.verdict.inputs = HashFiles(played.files);
  // Losing it only costs the blame of the next difference its answer.
  (void)records.Write(record);
  (void)WriteTrace(records.TracePath(played.id),
                   TraceOf(played.prepared.scenario.scene, played.run.recording));
}

/// "" or why it is not what a person was shown: by the fingerprint, or by the file that waits.
std::string NotWhatWasShown(const CLI::App& options, const CommandContext& context,
                            const Golden& pending) {
  const std::string now = Fingerprint(pending);
  if (IsGiven(options, "--reviewed")) {
    const std::string reviewed = ValueOf(options, "--reviewed");
    return reviewed == now ? "" : "what was reviewed was " + reviewed;
  }
  const ReadResult<Golden> waiting = GoldenFiles(context.root).ReadPendingOf(pending.scenario);
  if (!waiting.value || Fingerprint(*waiting.value) == now) return "";
  return "what waited for acceptance was " + Fingerprint(*waiting.value);
}

/// Shows what is there now instead, and lets it wait for the next acceptance.
ExitCode Refuse(const CommandContext& context, const Played& played, const Golden& pending,
                const std::string& why) {
  ShowDifference(played.old, played.prepared.scenario, played.run, played.id, context);
  const std::string problem = GoldenFiles(context.root).WritePending(pending);
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  return Complain(context, ExitCode::kDiffers,
                  why + ", but the scenario yields something else now, " + Fingerprint(pending) +
                      " (shown above); nothing was accepted\n  if that is right: prehend accept " +
                      played.id + " --reviewed " + Fingerprint(pending) + " --reason \"...\"");
}

bool SameNotes(const Golden& a, const Golden& b) {
  return std::ranges::equal(a.events, b.events, {}, &GoldenEvent::oracle, &GoldenEvent::oracle);
}

ExitCode AcceptEvents(const CLI::App& options, const CommandContext& context,
                      const Played& played) {
  const auto& [id, old, prepared, inputs, run] = played;
  const GoldenFiles files(context.root);
  const Derivation derivation = Derive(prepared.scenario, *prepared.program, run);
  Proposal proposal{.scenario = id,
                    .grammar = prepared.scenario.grammar,
                    .derived = ValuesOf(options, "--derived"),
                    .acceptance = Acceptance{context.today, ValueOf(options, "--reason")},
                    .notes = derivation.notes};
  const bool from_people = !proposal.derived.empty();
  if (!from_people && old) proposal.derived = old->derived;
  proposal.derived = RenewedDerivation(proposal.derived, derivation);
  const bool tells_derivation = from_people && (!old || old->derived != proposal.derived);
  const Golden golden = ProposeGolden(old, run.timeline, proposal);
  if (old && SaysTheSame(*old, run.timeline) && SameNotes(*old, golden) && !tells_derivation) {
    files.RemovePending(id);
    LeaveBaseline(context, played);
    context.out << "nothing to accept: " << files.GoldenPath(id).string()
                << " says the same already\n";
    return ExitCode::kAgrees;
  }
  const Golden pending = PendingGolden(old, run.timeline, id, prepared.scenario.grammar);
  const std::string why_not = NotWhatWasShown(options, context, pending);
  if (!why_not.empty()) return Refuse(context, played, pending, why_not);
  ShowDifference(old, prepared.scenario, run, id, context);
  for (const std::string& line : derivation.lines) context.out << line << "\n";
  const std::string problem = files.WriteAccepted(golden);
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
  LeaveBaseline(context, played);
  context.out << "accepted: " << files.GoldenPath(id).string() << "\n";
  return ExitCode::kAgrees;
}

ExitCode Run(const CLI::App& options, const CommandContext& context) {
  const std::string refusal = Refusal(options, context);
  if (!refusal.empty()) return Complain(context, ExitCode::kBadInput, refusal);
  const auto file = FindScenarioOrComplain(ValueOf(options, "scenario"), context);
  if (!file) return ExitCode::kNothing;
  if (!file->in_project) {
    return Complain(context, ExitCode::kBadInput,
                    "goldens are kept of scenarios in scenarios/ only; put the file there and "
                    "accept it by name");
  }
  Played played;
  played.id = ScenarioId(file->skill, file->name);
  played.files = {GoldenFiles(context.root).GoldenPath(played.id).string()};
  ReadResult<PreparedRun> prepared =
      PrepareRun({.scenario_file = file->path}, context.root, &played.files);
  if (!prepared.value) return Complain(context, prepared.diagnostics);
  played.prepared = std::move(*prepared.value);
  ReadResult<Golden> old = GoldenFiles(context.root).ReadGoldenOf(played.id);
  if (!old.diagnostics.empty()) return Complain(context, old.diagnostics);
  played.old = std::move(old.value);
  if (IsGiven(options, "--pictures") && !played.old) {
    return Complain(context, ExitCode::kPending,
                    "its events have no golden yet; accept them first, without --pictures");
  }

  played.run = RunScenario(played.prepared.scenario, played.prepared.program, {.record = true});
  if (played.run.status.kind != physics::RunStatus::Kind::kCompleted) {
    return Complain(context, ExitCode::kFailure,
                    "a run that did not complete is not accepted: " + StatusText(played.run));
  }
  if (!IsGiven(options, "--pictures")) return AcceptEvents(options, context, played);
  return AcceptPictures(options, context, *played.old, played.prepared.scenario, played.run);
}

}  // namespace

Command AcceptCommand() {
  return {
      .name = "accept",
      .summary = "Make what a scenario yields now its golden, with a reason",
      .examples =
          "prehend accept milk_carton_wrap --reason \"first golden, checked against the picture\"\n"
          "prehend accept milk_carton_wrap --reviewed 3fa90c11 --reason \"the grasp ends "
          "earlier\"\n"
          "prehend accept milk_carton_wrap --reason \"...\" --derived \"the reach begins with the "
          "hand's first motion\"\n"
          "prehend accept milk_carton_wrap --pictures --reason \"the carton is seen in the hand\"",
      .declare = Declare,
      .run = Run};
}

}  // namespace prehend::harness
