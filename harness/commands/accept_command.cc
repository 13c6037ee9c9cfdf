// SPDX-License-Identifier: Apache-2.0
// prehend accept: the only thing that writes goldens. It runs the scenario itself, so that what is
// accepted is what this build recognises now. Tested by tests/house/command_line_test.cc
#include <CLI/CLI.hpp>
#include <filesystem>

#include "harness/accept_golden.h"
#include "harness/check_scenario.h"
#include "harness/commands/command.h"
#include "harness/compare.h"
#include "harness/content_hash.h"
#include "harness/derivation.h"
#include "harness/golden_files.h"
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
  DeclareFlag(options, "--pictures", "its pictures become goldens, too, kept beside the timeline");
}

/// "" or why the command line alone is enough to refuse.
std::string Refusal(const CLI::App& options, const CommandContext& context) {
  if (context.in_ci) return "nothing is accepted where CI is set: a golden is a person's decision";
  if (ValueOf(options, "--reason").find_first_not_of(" \t") == std::string::npos) {
    return "accepting needs a reason: --reason \"why this is right\"";
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
std::optional<int> AcceptPictures(const CommandContext& context, const std::string& id,
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

ExitCode Write(const CLI::App& options, const CommandContext& context, const std::string& id,
               const std::optional<Golden>& old, const PreparedRun& prepared,
               const RunResult& run) {
  int new_pictures = 0;
  if (IsGiven(options, "--pictures")) {
    const auto changed = AcceptPictures(context, id, prepared.scenario, run);
    if (!changed) return ExitCode::kFailure;
    new_pictures = *changed;
  }
  const GoldenFiles files(context.root);
  Proposal proposal{.scenario = id,
                    .grammar = prepared.scenario.grammar,
                    .derived = ValuesOf(options, "--derived"),
                    .acceptance = Acceptance{context.today, ValueOf(options, "--reason")}};
  const Derivation derivation = Derive(prepared.scenario, *prepared.program, run);
  const bool from_people = !proposal.derived.empty();
  if (!from_people && old) proposal.derived = old->derived;
  proposal.derived = RenewedDerivation(proposal.derived, derivation);
  const bool tells_derivation = from_people && (!old || old->derived != proposal.derived);
  if (old && SaysTheSame(*old, run.timeline) && !tells_derivation && new_pictures == 0) {
    files.RemovePending(id);
    context.out << "nothing to accept: " << files.GoldenPath(id).string()
                << " says the same already\n";
    return ExitCode::kAgrees;
  }
  ShowDifference(old, prepared.scenario, run, id, context);
  for (const std::string& line : derivation.lines) context.out << line << "\n";
  const std::string problem = files.WriteAccepted(ProposeGolden(old, run.timeline, proposal));
  if (!problem.empty()) return Complain(context, ExitCode::kFailure, problem);
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
  const std::string id = ScenarioId(file->skill, file->name);
  const ReadResult<PreparedRun> prepared = PrepareRun({.scenario_file = file->path}, context.root);
  if (!prepared.value) return Complain(context, prepared.diagnostics);
  const ReadResult<Golden> old = GoldenFiles(context.root).ReadGoldenOf(id);
  if (!old.diagnostics.empty()) return Complain(context, old.diagnostics);

  const RunResult run =
      RunScenario(prepared.value->scenario, prepared.value->program, {.record = true});
  if (run.status.kind != physics::RunStatus::Kind::kCompleted) {
    return Complain(context, ExitCode::kFailure,
                    "a run that did not complete is not accepted: " + StatusText(run));
  }
  return Write(options, context, id, old.value, *prepared.value, run);
}

}  // namespace

Command AcceptCommand() {
  return {
      .name = "accept",
      .summary = "Make what a scenario yields now its golden, with a reason",
      .examples =
          "prehend accept milk_carton_wrap --reason \"first golden, checked against the picture\"\n"
          "prehend accept milk_carton_wrap --reason \"...\" --derived \"the reach begins with the "
          "hand's first motion\"\n"
          "prehend accept milk_carton_wrap --pictures --reason \"the carton is seen in the hand\"",
      .declare = Declare,
      .run = Run};
}

}  // namespace prehend::harness
