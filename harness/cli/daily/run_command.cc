// SPDX-License-Identifier: Apache-2.0
// prehend run. Tested by tests/program/command_line_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "harness/base/base/atomic_file.h"
#include "harness/base/base/content_hash.h"
#include "harness/base/base/quoting.h"
#include "harness/base/base/visible_stream.h"
#include "harness/cli/command/command.h"
#include "harness/episode/episodes/database.h"
#include "harness/episode/episodes/plan.h"
#include "harness/episode/episodes/record_episode.h"
#include "harness/episode/run/run_text.h"
#include "harness/episode/run/run_trials.h"
#include "harness/suite/check/check_scenario.h"
#include "harness/suite/check/run_suite.h"
#include "harness/suite/judge/judges.h"
#include "harness/suite/report/report.h"

namespace prehend::cli {
namespace {

constexpr int kMaxTrials = 100000;

/// The command that plays one trial again, without its number.
std::string TrialCommand(const ParsedOptions& options) {
  std::vector<std::string> words = {"run", options.Text("scenario")};
  if (options.Has("--grammar")) {
    words.push_back("--grammar");
    words.push_back(options.Text("--grammar"));
  }
  for (const std::string& setting : options.All("--set")) {
    words.push_back("--set");
    words.push_back(setting);
  }
  return CommandText(words);
}

episode::RecordRequest RecordingOf(const episode::RunRequest& request,
                                   const std::vector<std::string>& files,
                                   const ParsedOptions& options, const CommandContext& context) {
  return {options.Text("--record"), context.root, request, files, context.today, ProgramHash()};
}

/// The trials that are asked for: all, or a part of them.
episode::Plan PlanOfTrials(const ParsedOptions& options, const episode::RunRequest& request,
                           const std::string& id, const CommandContext& context) {
  const suite::Shard shard = *suite::ParseShard(options.TextOr("--shard", "1/1"));
  std::vector<std::string> words = {"run", id};
  std::ranges::copy(suite::OptionsOf({request.grammar, request.settings}),
                    std::back_inserter(words));
  episode::Plan plan = episode::MakePlan(words, {request.scenario_file}, context.root);
  const int count = options.IntOr("--trials", 1);
  plan.what += fmt::format(" --trials {}", count);
  plan.number = shard.number;
  plan.count = shard.count;
  for (int trial = 1; trial <= count; ++trial)
    plan.owed.push_back({fmt::format("{}, trial {}", id, trial), (trial - 1) % shard.count + 1});
  return plan;
}

/// The outcomes of those that the file has already.
Result<std::map<int, episode::TrialResult>> KnownTrials(const std::string& file,
                                                        const episode::Plan& plan) {
  PREHEND_TRY(const auto complete, episode::BeginPart(file, plan));
  std::map<int, episode::TrialResult> known;
  for (std::size_t i = 0; i < plan.owed.size(); ++i) {
    const auto row = complete.find(plan.owed[i].name);
    if (plan.owed[i].part != plan.number || row == complete.end()) continue;
    const bool failed = row->second.status == episode::kFailed;
    const physics::RunStatus& end = row->second.end;
    const int trial = static_cast<int>(i) + 1;
    known[trial] = {trial, failed ? "failed" : row->second.outcome,
                    failed ? end.entity + ": " + end.reason : "", ""};
  }
  return known;
}

ExitCode CountTrials(const ParsedOptions& options, const episode::RunRequest& request,
                     const std::string& id, const CommandContext& context) {
  const std::string file = options.Text("--record");
  if (options.Has("--record") && !episode::IsEpisodeFile(file))
    return Refuse(context, "--record: many trials need an episode file, NAME.episodes");
  const grammar::Diagnostics why_not = episode::WhyNotTried(request, context.root);
  if (!why_not.empty()) return Complain(context, why_not);
  const episode::Plan plan = PlanOfTrials(options, request, id, context);
  const auto all = std::ranges::count(plan.owed, plan.number, &episode::Plan::Owed::part);
  episode::TrialSettings settings{.count = options.IntOr("--trials", 1),
                                  .part = plan.number,
                                  .parts = plan.count,
                                  .jobs = options.IntOr("--jobs", CoreCount())};
  tl::expected<episode::WriteLock, std::string> lock;
  if (options.Has("--record")) {
    lock = episode::LockToRecord(file, episode::Writer::kAlone);
    if (!lock) return Refuse(context, "--record: " + lock.error());
    auto known = KnownTrials(file, plan);
    if (!known) return Complain(context, known.error());
    settings.known = std::move(*known);
    if (!settings.known.empty())
      context.err << fmt::format("{}: it has {} of {} trials already; these are not played again\n",
                                 file, settings.known.size(), all);
    ProgramHash();  // once, before each trial has a process of its own
    settings.play = [&](int trial, const episode::RunRequest& varied,
                        const episode::LoadedRun& loaded, const std::vector<std::string>& files) {
      episode::RecordRequest record = RecordingOf(varied, files, options, context);
      record.uuid = plan.UuidOfEpisode(plan.owed[static_cast<std::size_t>(trial) - 1].name);
      return episode::RecordTrial(trial, loaded, record);
    };
  }
  const auto report = episode::RunTrials(request, context.root, settings, [&](int done) {
    if (context.progress)
      context.err << kEraseLine << "[" << done + static_cast<int>(settings.known.size()) << "/"
                  << all << "]" << std::flush;
  });
  if (context.progress) context.err << kEraseLine << std::flush;
  if (!report) return Complain(context, report.error());
  if (options.Has("--json")) {
    context.out << episode::TrialJson(*report).dump(2) << "\n";
  } else {
    context.out << episode::TrialTable(*report, TrialCommand(options));
  }
  const auto is_lost = [](const auto& trial) { return !trial.not_recorded.empty(); };
  const auto lost = std::ranges::count_if(report->results, is_lost);
  if (lost == 0 && options.Has("--record")) {
    const std::string problem = episode::EndPart(file, plan);
    if (!problem.empty()) return Complain(context, ExitCode::kFailure, "--record: " + problem);
  }
  if (lost == 0) return ExitCode::kAgrees;
  const auto first = std::ranges::find_if(report->results, is_lost);
  return Complain(context, ExitCode::kFailure,
                  fmt::format("--record: {} of {} trials are not in the file; the first, {}: {}",
                              lost, report->results.size(), first->trial, first->not_recorded));
}

/// The run as a page, judged as a check judges it. Returns "", or why it could not be written.
std::string WriteReport(const ParsedOptions& options, const CommandContext& context,
                        const episode::ScenarioFile& file, const episode::RunRequest& request,
                        const episode::LoadedRun& loaded, const episode::RunResult& run,
                        const std::vector<std::string>& files) {
  const suite::CheckRequest check{.episode = NameOf(file),
                                  .changes = {request.grammar, request.settings},
                                  .id = episode::IdOf(file),
                                  .root = context.root,
                                  .replays = suite::Replays::kAll,
                                  .explain = true,
                                  .pictures = false,
                                  .leave_nothing_behind = true,
                                  .in_project = file.in_project,
                                  .today = context.today,
                                  .program = ProgramHash()};
  const suite::ScenarioVerdict verdict = suite::JudgeRun(check, loaded, run, files);
  suite::ReportHeader header =
      suite::HeaderOf(CommandText(context.words), context.root, context.today);
  header.title = "Run of " + verdict.scenario;
  return WriteTextFile(options.Text("--report"), suite::ReportHtml({verdict}, header));
}

/// Options that contradict each other, or a report that cannot be written.
std::string WhyRefused(const ParsedOptions& options) {
  for (const char* of_one_run : {"--trial", "--measure", "--report"}) {
    if (options.Has("--trials") && options.Has(of_one_run))
      return fmt::format("{} needs a single run; --trials makes many", of_one_run);
  }
  if (options.Has("--shard") && !options.Has("--trials"))
    return "--shard is a part of many runs; it needs --trials";
  if (options.Has("--shard") && !suite::ParseShard(options.Text("--shard"))->costs.empty())
    return "--shard: trials cost the same: found a file of costs, wanted I/N";
  if (options.Has("--trials")) return "";
  for (const char* of_output : {"--json", "--measure"}) {
    if (options.Text("--record") == "-" && options.Has(of_output))
      return fmt::format("--record - contradicts {}: both would be printed", of_output);
  }
  if (!options.Has("--report")) return "";
  const std::string problem = WhyNotWritable(options.Text("--report"));
  return problem.empty() ? "" : "--report: " + problem;
}

void Print(const episode::LoadedRun& loaded, const episode::RunResult& run,
           const std::vector<truth::ClaimVerdict>& claims, const ParsedOptions& options,
           const CommandContext& context) {
  for (const std::string& note : episode::NoteLines(loaded.scenario, run))
    context.err << note << "\n";
  const bool measure = options.Has("--measure");
  if (options.Has("--json")) {
    episode::OrderedJson json = episode::RunJson(episode::HeadingOf(loaded.scenario, run), run);
    json["claims"] = truth::ClaimsJson(claims);
    if (measure) json["measured"] = episode::MeasurementJson(episode::Measure(run));
    context.out << json.dump(2) << "\n";
  } else if (options.Text("--record") != "-") {
    context.out << episode::RunTable(run);
    if (measure) context.out << episode::MeasurementText(episode::Measure(run));
    context.out << std::flush;
  }
  context.err << truth::TextOfUndecided(claims) << truth::TextOfContradicted(claims);
}

ExitCode PlayOne(const episode::ScenarioFile& file, const episode::RunRequest& request,
                 const ParsedOptions& options, const CommandContext& context) {
  std::vector<std::string> files;
  const Result<episode::LoadedRun> loaded = episode::LoadRun(request, context.root, &files);
  if (!loaded) return Complain(context, loaded.error());
  Warn(context, loaded->warnings);
  tl::expected<episode::WriteLock, std::string> lock;
  if (options.Has("--record") && episode::IsEpisodeFile(options.Text("--record")))
    lock = episode::LockToRecord(options.Text("--record"), episode::Writer::kAdds);
  if (!lock) return Refuse(context, "--record: " + lock.error());
  std::optional<episode::RunRecorder> recorder;
  if (options.Has("--record")) {
    recorder.emplace(RecordingOf(request, files, options, context), *loaded);
    if (!recorder->problem().empty()) return Refuse(context, "--record: " + recorder->problem());
  }
  const episode::RunResult run = episode::PlayScenario(
      *loaded, {.record = options.Has("--report"), .measure = options.Has("--measure")},
      recorder ? &*recorder : nullptr);
  const bool completed = run.status.kind == physics::RunStatus::Kind::kCompleted;
  // Of an unfinished run the claims may still come true.
  std::vector<truth::ClaimVerdict> claims;
  if (completed) {
    claims = suite::JudgeClaims(*loaded, run.timeline);
    std::ranges::move(suite::JudgeLimitClaims(loaded->scenario, run.notes),
                      std::back_inserter(claims));
  }
  Print(*loaded, run, claims, options, context);
  if (recorder && !recorder->problem().empty())
    return Complain(context, ExitCode::kFailure, "--record: " + recorder->problem());
  if (options.Has("--report")) {
    const std::string problem = WriteReport(options, context, file, request, *loaded, run, files);
    if (!problem.empty()) return Complain(context, ExitCode::kFailure, "--report: " + problem);
  }
  return completed ? ExitCode::kAgrees
                   : Complain(context, ExitCode::kFailure, episode::StatusText(run));
}

ExitCode RunOne(const ParsedOptions& options, const CommandContext& context) {
  PREHEND_TRY(const auto file, FindScenarioOrComplain(options.Text("scenario"), context));
  episode::RunRequest request = RequestOf(options, file.path);
  if (const std::string why = WhyRefused(options); !why.empty()) return Refuse(context, why);
  if (options.Has("--trials")) return CountTrials(options, request, episode::IdOf(file), context);
  if (options.Has("--trial")) {
    auto varied = episode::RequestOfTrial(request, context.root, options.IntOr("--trial", 1));
    if (!varied) return Complain(context, varied.error());
    context.err << episode::SampledText(request, *varied);
    request = std::move(*varied);
  }
  return PlayOne(file, request, options, context);
}

}  // namespace

Command RunCommand() {
  return {
      .name = "run",
      .summary = "Simulate one scenario and print the events that its grammar recognises",
      .examples =
          {"run milk_carton_wrap", "run milk_carton_wrap --json",
           "run milk_carton_wrap --record milk.episodes", "run milk_carton_wrap --report milk.html",
           "run milk_carton_wrap --set entities.milk.mass_kg=8",
           "run milk_carton_wrap --set lift_rise=10cm --measure",
           "run furniture/drawer_is_opened_with_hook --trials 50",
           "run furniture/drawer_is_opened_with_hook --trial 17",
           "run trials/wrap_places_a_carton --trials 800 --shard 3/8 --record part-3.episodes",
           "run my/scenario.yaml --grammar my/rules.grammar"},
      .options =
          {ScenarioArgument(), GrammarOption(), SettingsOption(),
           Value("--trials", "N", "simulate N variations of the scenario and count the outcomes",
                 IntegersFrom(1, kMaxTrials)),
           Value("--trial", "K", "simulate variation K only", IntegersFrom(1, kMaxTrials)),
           Value("--shard", "I/N", "keep part I of N of the trials",
                 {.problem = suite::ShardProblem}),
           JobsOption(), JsonOption(),
           WritesFile(Value(
               "--record", "FILE",
               "write the episode to FILE: NAME.episodes holds many episodes and all of each; "
               "any other ending: what the grammar sees, as JSON Lines; -: print these "
               "instead of the table. With --trials: NAME.episodes, an episode per trial")),
           WritesFile(
               Value("--report", "FILE",
                     "also write the run as a web page with its 3D replay, judged as by check")),
           Flag("--measure", "print where the time went, and the peak memory")},
      .run = RunOne,
      .note =
          "It shows and does not judge: claims that the events contradict are printed, and the "
          "exit\n"
          "code is 0 all the same. 'check' judges."};
}

}  // namespace prehend::cli
