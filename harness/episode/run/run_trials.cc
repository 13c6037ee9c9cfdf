// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/run/run_trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "harness/base/process/worker_pool.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/scenario/format/scenario_fields.h"
#include "harness/scenario/read/sample_variations.h"
#include "physics/scene/geometry.h"
#include "physics/simulation.h"

namespace prehend::episode {

namespace {

double TiltDeg(const physics::Pose& placed, const physics::Pose& now) {
  const Eigen::Vector3d up = now.q * (placed.q.conjugate() * Eigen::Vector3d::UnitZ());
  return std::acos(std::clamp(up.z(), -1.0, 1.0)) * 180 / std::numbers::pi;
}

bool Within(const std::vector<double>& wanted, double within_m, const Eigen::Vector3d& p) {
  const double x = wanted[0] - p.x(), y = wanted[1] - p.y(),
               z = wanted.size() > 2 ? wanted[2] - p.z() : 0;
  return std::sqrt(x * x + y * y + z * z) <= within_m;
}

}  // namespace

OutcomeWatch::OutcomeWatch(const physics::Scene& scene,
                           const std::vector<scenario::Outcome>& outcomes)
    : scene_(scene), outcomes_(outcomes) {
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    for (std::size_t k = 0; k < outcomes[i].conditions.size(); ++k) {
      const auto& at_s = outcomes[i].conditions[k].wanted.at_s;
      if (at_s) timed_.push_back({std::llround(*at_s * scene.world.rate_hz), i, k, false});
    }
  }
}

void OutcomeWatch::Look(const physics::Snapshot& snapshot) {
  for (TimedCondition& timed : timed_) {
    if (timed.tick == snapshot.tick)
      timed.holds = Holds(outcomes_[timed.outcome].conditions[timed.condition], snapshot);
  }
}

std::string OutcomeWatch::Judge(const physics::Snapshot& last) const {
  for (std::size_t i = 0; i < outcomes_.size(); ++i) {
    bool holds = true;
    for (const auto& condition : outcomes_[i].conditions)
      holds &= condition.wanted.at_s || Holds(condition, last);
    for (const TimedCondition& timed : timed_) holds &= timed.outcome != i || timed.holds;
    if (holds) return outcomes_[i].name;
  }
  return kOtherOutcome;
}

bool OutcomeWatch::Holds(const scenario::Outcome::Condition& condition,
                         const physics::Snapshot& snapshot) const {
  const scenario::ConditionYaml& wanted = condition.wanted;
  const physics::Body& body = scene_.body(condition.body);
  const physics::BodyState& state = snapshot.body(condition.body);
  const Eigen::Vector3d centre = state.X_WB * physics::BoundingBox(body).p_BC_m;
  const double tilt_deg = TiltDeg(body.X_WB, state.X_WB);
  const double fraction =
      condition.joint < 0 ? 0 : snapshot.joints[static_cast<std::size_t>(condition.joint)].fraction;
  return (!wanted.near_m || Within(*wanted.near_m, wanted.within_m, centre)) &&
         (!wanted.above_m || centre.z() > *wanted.above_m) &&
         (!wanted.below_m || centre.z() < *wanted.below_m) &&
         (!wanted.tilt_below_deg || tilt_deg < *wanted.tilt_below_deg) &&
         (!wanted.tilt_above_deg || tilt_deg > *wanted.tilt_above_deg) &&
         (!wanted.slower_than_m_per_s || state.v_WB_m_per_s.norm() < *wanted.slower_than_m_per_s) &&
         (!wanted.joint_above || fraction > *wanted.joint_above) &&
         (!wanted.joint_below || fraction < *wanted.joint_below) &&
         (!wanted.inside || ShareInside(condition, snapshot) >= wanted.share);
}

/// The share of the body's grains that are inside the vessel; 0 or 1 for a body without grains.
double OutcomeWatch::ShareInside(const scenario::Outcome::Condition& condition,
                                 const physics::Snapshot& snapshot) const {
  const physics::Body &vessel = scene_.body(condition.vessel), &body = scene_.body(condition.body);
  const physics::Pose& X_WV = snapshot.body(condition.vessel).X_WB;
  if (!body.grains) {
    const Eigen::Vector3d p_W_m =
        snapshot.body(condition.body).X_WB * physics::BoundingBox(body).p_BC_m;
    return physics::IsInside(vessel, X_WV, p_W_m) ? 1 : 0;
  }
  const std::span<const Eigen::Vector3d> grains =
      physics::GrainsOf(scene_, condition.body, snapshot);
  const auto inside = std::count_if(
      grains.begin(), grains.end(),
      [&](const Eigen::Vector3d& p_W_m) { return physics::IsInside(vessel, X_WV, p_W_m); });
  return static_cast<double>(inside) / static_cast<double>(grains.size());
}

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TrialResult, trial, outcome, reason, not_recorded)

namespace {

constexpr const char* kFailed = "failed";
constexpr double kTimeLimit_s = 600;
constexpr std::size_t kMaxListed = 20;

/// Trials have other values of the same files: hands and grammars are read once, before each trial
/// has a process of its own. Afterwards `files` are all that were tried.
struct TrialLoader {
  const std::string root;
  std::vector<std::string> files = {};
  const scenario::ScenarioLibrary library = ProjectLibrary(root, &files);
  using Compiled = std::pair<grammar::CompileResult, std::vector<std::string>>;
  std::map<std::pair<std::string, grammar::Overrides>, Compiled> known = {};

  Result<LoadedRun> Load(const RunRequest& request) {
    files.clear();
    const auto load_grammar = [&](const std::string& name, const grammar::Overrides& parameters) {
      const auto [found, is_new] = known.try_emplace({name, parameters});
      auto& [compiled, its_files] = found->second;
      if (is_new) compiled = LoadGrammar(root, name, parameters, &its_files);
      files.insert(files.end(), its_files.begin(), its_files.end());
      return compiled;
    };
    return LoadRun(request, root, library, load_grammar, &files);
  }
};

/// What the trials vary: with the changes of the command line in its document.
Result<LoadedRun> LoadNominal(const RunRequest& request, TrialLoader& loader) {
  Result<LoadedRun> loaded = loader.Load(request);
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
  TrialLoader loader{root};
  PREHEND_TRY(const LoadedRun nominal, LoadNominal(request, loader));
  return WithDraws(request, nominal, trial);
}

grammar::Diagnostics WhyNotTried(const RunRequest& request, const std::string& root) {
  TrialLoader loader{root};
  const Result<LoadedRun> nominal = LoadNominal(request, loader);
  if (!nominal) return nominal.error();
  if (!nominal->scenario.outcomes.empty()) return {};
  return {grammar::DiagnosticAt(request.scenario_file, "", {1, 1},
                                "the scenario has no outcomes, so its trials cannot be classified",
                                "outcomes: {lifted: [{entity: milk, above_m: 0.9}]}")};
}

Result<TrialReport> RunTrials(const RunRequest& request, const std::string& root,
                              const TrialSettings& settings,
                              const std::function<void(int done)>& progress) {
  TrialLoader loader{root};
  PREHEND_TRY(const LoadedRun nominal, LoadNominal(request, loader));
  const scenario::Scenario& scenario = nominal.scenario;
  std::vector<WorkerJob> jobs;
  TrialReport report;
  for (int trial = settings.part; trial <= settings.count; trial += settings.parts) {
    const auto known = settings.known.find(trial);
    report.results.push_back(known == settings.known.end() ? TrialResult{trial, {}, {}, {}}
                                                           : known->second);
    if (known != settings.known.end()) continue;
    jobs.push_back([&, trial]() -> std::string {
      const RunRequest varied = WithDraws(request, nominal, trial);
      const auto loaded = loader.Load(varied);
      if (!loaded)
        return ToWire(TrialResult{
            trial, kFailed, "it cannot be read:\n" + grammar::Format(loaded.error()), {}});
      if (settings.play) return ToWire(settings.play(trial, varied, *loaded, loader.files));
      return ToWire(RunTrial(loaded->scenario, trial));
    });
  }
  int done = 0;
  const auto workers = RunInWorkers(jobs, {.jobs = settings.jobs, .time_limit_s = kTimeLimit_s},
                                    [&](std::size_t, const WorkerResult&) {
                                      if (progress) progress(++done);
                                    });
  for (const scenario::Outcome& outcome : scenario.outcomes)
    report.outcomes.push_back(outcome.name);
  auto worker = workers.begin();
  for (TrialResult& result : report.results)
    if (result.outcome.empty()) result = FromWorker(result.trial, *worker++);
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
  if (results.empty()) return "no trial is of this part\n";
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
