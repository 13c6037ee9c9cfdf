// SPDX-License-Identifier: Apache-2.0
// prehend run. Tested by tests/program/command_line_test.cc
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <thread>

#include "harness/base/atomic_file.h"
#include "harness/base/shell_quote.h"
#include "harness/cli/command.h"
#include "harness/cli/warn.h"
#include "harness/run/outcome.h"
#include "harness/run/run_text.h"
#include "harness/run/run_trials.h"
#include "harness/sense/entity_table.h"
#include "harness/sense/episode_file.h"

namespace prehend::harness {
namespace {

constexpr int kMaxTrials = 100000;

void Declare(CLI::App& options) {
  options.add_option("scenario", "a name, skill/name or a file")->required()->expected(1);
  DeclareRunOptions(options);
  options
      .add_option("--trials",
                  "simulate this many variations of the scenario and count its outcomes")
      ->type_name("N")
      ->expected(1)
      ->check(CLI::Range(1, kMaxTrials));
  options.add_option("--trial", "simulate one of these variations")
      ->type_name("K")
      ->expected(1)
      ->check(CLI::Range(1, kMaxTrials));
  options.add_option("--jobs", "trials at a time; default: one per core")
      ->type_name("N")
      ->expected(1)
      ->check(CLI::Range(1, 256));
  DeclareFlag(options, "--json", "one JSON object instead of a table");
  options
      .add_option("--record",
                  "write the episode to FILE, for 'prehend resegment'; -: print it, instead of the "
                  "table")
      ->type_name("FILE")
      ->expected(1);
  DeclareFlag(options, "--measure", "say where the time went, and the peak memory");
}

/// The command that shows one trial again, but for its number.
std::string AgainCommand(const CLI::App& options) {
  std::string command = "prehend run " + ShellQuoted(ValueOf(options, "scenario"));
  if (IsGiven(options, "--grammar"))
    command += " --grammar " + ShellQuoted(ValueOf(options, "--grammar"));
  for (const std::string& setting : ValuesOf(options, "--set"))
    command += " --set " + ShellQuoted(setting);
  return command;
}

ExitCode CountTrials(const CLI::App& options, const RunRequest& request,
                     const CommandContext& context) {
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const TrialSettings settings{
      .count = std::stoi(ValueOf(options, "--trials")),
      .jobs = std::stoi(ValueOf(options, "--jobs", std::to_string(cores)))};
  const auto report = RunTrials(request, context.root, settings, [&](int done) {
    if (context.progress)
      context.err << "\r\033[K[" << done << "/" << settings.count << "]" << std::flush;
  });
  if (context.progress) context.err << "\r\033[K" << std::flush;
  if (!report.value) return Complain(context, report.diagnostics);
  if (IsGiven(options, "--json")) {
    context.out << TrialJson(*report.value).dump(2) << "\n";
  } else {
    context.out << TrialTable(*report.value, AgainCommand(options));
  }
  return ExitCode::kAgrees;
}

/// Plays the scenario, writes what is sensed to `recorder` unless that is null, and judges the
/// scenario's outcomes.
RunResult Play(const LoadedRun& loaded, bool measure, EpisodeWriter* recorder) {
  const Scenario& scenario = loaded.scenario;
  OutcomeWatch outcomes(scenario.scene, scenario.outcomes);
  ScenarioRun playing(scenario, loaded.program, {.measure = measure});
  while (playing.Step()) {
    outcomes.Look(playing.snapshot());
    if (recorder && playing.sensed()) recorder->Write(playing.frame());
  }
  RunResult run = playing.Finish();
  if (!scenario.outcomes.empty() && run.status.kind == physics::RunStatus::Kind::kCompleted)
    run.outcome = outcomes.Judge(playing.snapshot());
  return run;
}

ExitCode Run(const CLI::App& options, const CommandContext& context) {
  const auto file = FindScenarioOrComplain(ValueOf(options, "scenario"), context);
  if (!file) return ExitCode::kNothing;
  RunRequest request = RequestOf(options, file->path);
  for (const char* of_one_run : {"--trial", "--record", "--measure"}) {
    if (IsGiven(options, "--trials") && IsGiven(options, of_one_run))
      return Complain(context, ExitCode::kBadInput,
                      fmt::format("{} is about one run, --trials about many", of_one_run));
  }
  if (IsGiven(options, "--trials")) return CountTrials(options, request, context);
  if (IsGiven(options, "--trial")) {
    auto varied = RequestOfTrial(request, context.root, std::stoi(ValueOf(options, "--trial")));
    if (!varied.value) return Complain(context, varied.diagnostics);
    for (std::size_t i = request.settings.size(); i < varied.value->settings.size(); ++i)
      context.err << "drawn: " << varied.value->settings[i] << "\n";
    request = std::move(*varied.value);
  }
  const bool record_is_output = ValueOf(options, "--record") == "-";
  for (const char* of_output : {"--json", "--measure"}) {
    if (record_is_output && IsGiven(options, of_output))
      return Complain(
          context, ExitCode::kBadInput,
          fmt::format("--record - and {} contradict each other: both are printed", of_output));
  }
  const ReadResult<LoadedRun> loaded = LoadRun(request, context.root);
  if (!loaded.value) return Complain(context, loaded.diagnostics);
  Warn(context, loaded.value->warnings);

  const bool measure = IsGiven(options, "--measure");
  std::optional<AtomicFile> record;
  std::optional<EpisodeWriter> recorder;
  if (IsGiven(options, "--record")) {
    record.emplace(ValueOf(options, "--record"));
    if (!record->problem().empty())
      return Complain(context, ExitCode::kBadInput, "--record: " + record->problem());
    const Scenario& scenario = loaded.value->scenario;
    recorder.emplace(record->stream(),
                     EpisodeHeader{scenario.name, scenario.grammar, MakeEntityTable(scenario)});
  }
  const RunResult run = Play(*loaded.value, measure, recorder ? &*recorder : nullptr);
  for (const std::string& note : NoteLines(loaded.value->scenario, run))
    context.err << note << "\n";
  std::string not_recorded;
  if (recorder) {
    recorder->Finish(run.ticks + 1);
    not_recorded = record->Commit();
  }
  if (IsGiven(options, "--json")) {
    OrderedJson json = RunJson(loaded.value->scenario, run);
    if (measure) json["measured"] = MeasurementJson(Measure(run));
    context.out << json.dump(2) << "\n";
  } else if (!record_is_output) {
    context.out << RunTable(run);
    if (measure) context.out << MeasurementText(Measure(run));
  }
  if (!not_recorded.empty())
    return Complain(context, ExitCode::kFailure, "--record: " + not_recorded);
  if (run.status.kind == physics::RunStatus::Kind::kCompleted) return ExitCode::kAgrees;
  return Complain(context, ExitCode::kFailure, StatusText(run));
}

}  // namespace

Command RunCommand() {
  return {.name = "run",
          .summary = "Simulate one scenario and print what its grammar recognises",
          .examples =
              "prehend run milk_carton_wrap\n"
              "prehend run milk_carton_wrap --json\n"
              "prehend run milk_carton_wrap --record milk.jsonl\n"
              "prehend run milk_carton_wrap --set entities.milk.mass_kg=8\n"
              "prehend run milk_carton_wrap --set lift_rise=10cm --measure\n"
              "prehend run furniture/drawer_is_opened_with_hook --trials 50\n"
              "prehend run furniture/drawer_is_opened_with_hook --trial 17\n"
              "prehend run my/scenario.yaml --grammar my/rules.grammar",
          .declare = Declare,
          .run = Run};
}

}  // namespace prehend::harness
