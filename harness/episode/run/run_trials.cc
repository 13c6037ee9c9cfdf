// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/run/run_trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/base/process/wire.h"
#include "harness/base/process/worker_pool.h"
#include "harness/episode/run/outcome.h"
#include "harness/scenario/format/scenario_fields.h"
#include "harness/scenario/read/sample_variations.h"
#include "physics/simulation.h"

namespace prehend::episode {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TrialResult, trial, outcome, reason, not_recorded)

namespace {

constexpr const char* kFailed = "failed";
constexpr double kTimeLimit_s = 600;
constexpr std::size_t kMaxListed = 20;

/// What the trials vary: with the changes of the command line in its document.
Result<LoadedRun> LoadNominal(const RunRequest& request, const std::string& root) {
  Result<LoadedRun> loaded = LoadRun(request, root);
  if (!loaded) return loaded;
  for (const std::string& setting : request.settings) {
    if (IsFieldOfScenario(setting.substr(0, setting.find('='))))
      // LoadRun() has accepted the setting, so it cannot fail.
      (void)ApplyOverride(setting, scenario::ScenarioFormat().schema().json(), loaded->document);
  }
  return loaded;
}

/// Draws one trial. A field that the command line sets is not varied.
RunRequest WithDraws(const RunRequest& request, const LoadedRun& nominal, int trial) {
  const scenario::Scenario& scenario = nominal.scenario;
  RunRequest varied = request;
  for (std::string& drawn : scenario::SampleTrial(nominal.document, scenario.variations,
                                                  scenario.scene.world.seed, trial)) {
    const std::string field = drawn.substr(0, drawn.find('=') + 1);
    const bool set = std::ranges::any_of(
        request.settings, [&](const std::string& given) { return given.starts_with(field); });
    if (!set) varied.settings.push_back(std::move(drawn));
  }
  return varied;
}

/// Simulates one trial without a grammar.
TrialResult RunTrial(const scenario::Scenario& scenario, int trial) {
  physics::Simulation simulation(scenario.scene, scenario.script);
  OutcomeWatch watch(scenario.scene, scenario.outcomes);
  while (simulation.Step()) watch.Look(simulation.snapshot());
  const physics::RunStatus& status = simulation.status();
  if (status.kind == physics::RunStatus::Kind::kFailed)
    return {trial, kFailed, status.entity + ": " + status.reason, {}};
  return {trial, watch.Judge(simulation.snapshot()), {}, {}};
}

TrialResult FromWorker(int trial, const WorkerResult& worker) {
  if (!worker.finished) return {trial, kFailed, worker.reason, {}};
  return FromWire<TrialResult>(worker.output);
}

std::string TableLine(const std::string& outcome, std::size_t count, std::size_t of) {
  return fmt::format("{:<24} {:>5}  {:>5.1f} %\n", outcome, count,
                     100.0 * static_cast<double>(count) / static_cast<double>(of));
}

std::vector<std::string> AllOutcomes(const TrialReport& report) {
  std::vector<std::string> names = report.outcomes;
  names.insert(names.end(), {kOtherOutcome, kFailed});
  return names;
}

std::size_t CountOf(const std::string& outcome, const TrialReport& report) {
  return static_cast<std::size_t>(
      std::ranges::count(report.results, outcome, &TrialResult::outcome));
}

}  // namespace

Result<RunRequest> RequestOfTrial(const RunRequest& request, const std::string& root, int trial) {
  const Result<LoadedRun> nominal = LoadNominal(request, root);
  if (!nominal) return tl::unexpected(nominal.error());
  return WithDraws(request, *nominal, trial);
}

Result<TrialReport> RunTrials(const RunRequest& request, const std::string& root,
                              const TrialSettings& settings,
                              const std::function<void(int done)>& progress) {
  const Result<LoadedRun> nominal = LoadNominal(request, root);
  if (!nominal) return tl::unexpected(nominal.error());
  const scenario::Scenario& scenario = nominal->scenario;
  if (scenario.outcomes.empty()) {
    return tl::unexpected(grammar::Diagnostics{
        grammar::DiagnosticAt(request.scenario_file, "", {1, 1},
                              "the scenario has no outcomes, so its trials cannot be classified",
                              "outcomes: {lifted: [{entity: milk, above_m: 0.9}]}")});
  }
  std::vector<WorkerJob> jobs;
  for (int trial = 1; trial <= settings.count; ++trial) {
    jobs.push_back([&, trial]() -> std::string {
      const RunRequest varied = WithDraws(request, *nominal, trial);
      const auto loaded = LoadRun(varied, root);
      if (!loaded)
        return ToWire(TrialResult{
            trial, kFailed, "it cannot be read:\n" + grammar::Format(loaded.error()), {}});
      if (settings.play) return ToWire(settings.play(trial, varied));
      return ToWire(RunTrial(loaded->scenario, trial));
    });
  }
  int done = 0;
  const auto workers = RunInWorkers(jobs, {.jobs = settings.jobs, .time_limit_s = kTimeLimit_s},
                                    [&](std::size_t, const WorkerResult&) {
                                      if (progress) progress(++done);
                                    });
  TrialReport report;
  for (const scenario::Outcome& outcome : scenario.outcomes)
    report.outcomes.push_back(outcome.name);
  for (std::size_t i = 0; i < workers.size(); ++i)
    report.results.push_back(FromWorker(static_cast<int>(i) + 1, workers[i]));
  return report;
}

std::string SampledText(const RunRequest& request, const RunRequest& varied) {
  std::string text;
  for (std::size_t i = request.settings.size(); i < varied.settings.size(); ++i)
    text += "sampled: " + varied.settings[i] + "\n";
  return text;
}

nlohmann::ordered_json TrialJson(const TrialReport& report) {
  nlohmann::ordered_json outcomes, results = nlohmann::ordered_json::array();
  for (const std::string& name : AllOutcomes(report)) outcomes[name] = CountOf(name, report);
  for (const TrialResult& result : report.results)
    results.push_back(
        {{"trial", result.trial}, {"outcome", result.outcome}, {"reason", result.reason}});
  return {{"trials", report.results.size()},
          {"outcomes", std::move(outcomes)},
          {"results", std::move(results)}};
}

std::string TrialTable(const TrialReport& report, const std::string& command) {
  const std::vector<TrialResult>& results = report.results;
  const std::vector<std::string> names = AllOutcomes(report);
  std::string table;
  for (const std::string& name : names) {
    const std::size_t count = CountOf(name, report);
    const bool own = name != kOtherOutcome && name != kFailed;
    if (own || count > 0) table += TableLine(name, count, results.size());
  }
  // The worst first: failed trials, then the outcomes from the last to the first.
  std::size_t listed = 0, more = 0;
  for (std::size_t i = names.size(); i-- > 1;) {
    for (const TrialResult& result : results) {
      if (result.outcome != names[i]) continue;
      if (++listed > kMaxListed) {
        ++more;
        continue;
      }
      const std::string reason = result.reason.empty() ? "" : " (" + result.reason + ")";
      table += fmt::format("trial {}: {}{}\n  again: {} --trial {}\n", result.trial, result.outcome,
                           reason, command, result.trial);
    }
  }
  if (more > 0) table += fmt::format("and {} more\n", more);
  return table;
}

}  // namespace prehend::episode
