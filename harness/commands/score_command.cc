// SPDX-License-Identifier: Apache-2.0
// prehend score: grammars against the physical oracle. Tested by tests/house/score_test.cc
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <thread>

#include "harness/commands/command.h"
#include "harness/judge_episode.h"
#include "harness/load_grammar.h"
#include "harness/score/score.h"
#include "harness/select_scenarios.h"
#include "harness/timeline_json.h"
#include "harness/worker_pool.h"

namespace prehend::harness {
namespace {

using Json = nlohmann::ordered_json;
using score::JudgedEpisode;

constexpr double kDefaultCollar_ms = 50;
constexpr double kTimeLimit_s = 300;

void Declare(CLI::App& options) {
  options.add_option("names", "names, skill/name or globs; nothing: all")
      ->expected(-1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  options
      .add_option("--filter", "only those that match this glob, or have tag:NAME; see prehend check --help")
      ->type_name("[!]GLOB|[!]tag:NAME")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  options.add_option("--grammar", "a grammar to score, may be given again; otherwise pick_and_place and original_2020")
      ->type_name("NAME|FILE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  options.add_option("--collar-ms", "how far off a boundary may be for the scores at a collar; otherwise 50")
      ->type_name("MS")
      ->expected(1)
      ->check(CLI::Range(0.0, 10000.0));
  DeclareFlag(options, "--json", "one JSON object instead of tables");
}

/// What a worker sends: {"problem"} or {"episodes": [{"ticks", "truth", "found"}, ..]}, one per grammar.
std::string Judged(const JudgeRequest& request) {
  const auto episodes = JudgeEpisode(request);
  if (!episodes.value) return Json{{"problem", Format(episodes.diagnostics)}}.dump();
  Json sent = Json::array();
  for (const JudgedEpisode& episode : *episodes.value) {
    sent.push_back({{"ticks", episode.ticks},
                    {"truth", TimelineJson(episode.truth)},
                    {"found", TimelineJson(episode.found)}});
  }
  return Json{{"episodes", std::move(sent)}}.dump();
}

/// Episodes by grammar; what could not be played is told on `context.err` and counted.
std::vector<std::vector<JudgedEpisode>> JudgeAll(const ScenarioSelection& selection,
                                                 const std::vector<std::string>& grammars,
                                                 const CommandContext& context, int& failed) {
  std::vector<WorkerJob> jobs;
  std::vector<std::string> ids;
  for (const ScenarioFile& file : selection.scenarios) {
    ids.push_back(ScenarioId(file.skill, file.name));
    const JudgeRequest request{file.path, ids.back(), context.root, grammars};
    jobs.push_back([request] { return Judged(request); });
  }
  const WorkerLimits limits{.jobs = std::max(1, static_cast<int>(std::thread::hardware_concurrency())),
                            .time_limit_s = kTimeLimit_s};
  const std::vector<WorkerResult> results = RunInWorkers(jobs, limits);
  std::vector<std::vector<JudgedEpisode>> by_grammar(grammars.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Json sent = results[i].finished ? Json::parse(results[i].output) : Json{{"problem", results[i].reason + "\n"}};
    if (sent.contains("problem")) {
      context.err << "prehend: " << ids[i] << " is not scored: " << sent["problem"].get<std::string>();
      ++failed;
      continue;
    }
    for (std::size_t g = 0; g < grammars.size(); ++g) {
      const Json& episode = sent["episodes"][g];
      by_grammar[g].push_back({ids[i], episode["ticks"], TimelineFromJson(episode["truth"]), TimelineFromJson(episode["found"])});
    }
  }
  return by_grammar;
}

Json BoundaryJson(const score::BoundaryErrors& errors) {
  return {{"median", errors.Median()}, {"p95", errors.AbsoluteQuantile(0.95)}, {"max", errors.AbsoluteQuantile(1)}};
}

Json EventScoreJson(const score::EventScore& s) {
  const score::WardEvents& ward = s.ward.events;
  return {{"event", s.event},
          {"true", s.truths},
          {"found", s.found},
          {"ward",
           {{"correct", ward.correct},
            {"deleted", ward.deleted},
            {"fragmented", ward.fragmented},
            {"merged", ward.merged},
            {"fragmented_and_merged", ward.fragmented_and_merged},
            {"inserted", ward.inserted}}},
          {"begin_s", BoundaryJson(s.begin)},
          {"end_s", BoundaryJson(s.end)},
          {"f1_10", s.overlap_10.F1()},
          {"f1_25", s.overlap_25.F1()},
          {"f1_50", s.overlap_50.F1()},
          {"edit", s.edit},
          {"frame_accuracy", s.frames.Accuracy()},
          {"collar_f", s.within_collar.AsHits().F1()},
          {"collar_error_rate", s.within_collar.ErrorRate()},
          {"latency_s", {{"median", s.LatencyQuantile(0.5)}, {"max", s.LatencyQuantile(1)}}}};
}

Json ScoresJson(const std::vector<score::Score>& scores, double collar_s) {
  Json grammars = Json::array();
  for (const score::Score& s : scores) {
    Json events = Json::array();
    for (const score::EventScore& event : s.events) events.push_back(EventScoreJson(event));
    grammars.push_back({{"grammar", s.grammar},
                        {"episodes", s.episodes},
                        {"total", EventScoreJson(s.total)},
                        {"events", std::move(events)}});
  }
  return {{"collar_s", collar_s}, {"grammars", std::move(grammars)}};
}

ExitCode Run(const CLI::App& options, const CommandContext& context) {
  std::vector<std::string> grammars = ValuesOf(options, "--grammar");
  if (grammars.empty()) grammars = {"pick_and_place", "original_2020"};
  for (const std::string& name : grammars) {
    const grammar::CompileResult compiled = LoadGrammar(context.root, name);
    if (!compiled.program) return Complain(context, compiled.diagnostics);
  }
  std::string problem;
  const auto selection =
      SelectScenarios(ValuesOf(options, "names"), ValuesOf(options, "--filter"), context.root, problem);
  if (!selection) return Complain(context, ExitCode::kNothing, problem);

  int failed = 0;
  const auto by_grammar = JudgeAll(*selection, grammars, context, failed);
  const double collar_s = std::stod(ValueOf(options, "--collar-ms", std::to_string(kDefaultCollar_ms))) / 1000;
  std::vector<score::Score> scores;
  for (std::size_t g = 0; g < grammars.size(); ++g) scores.push_back(ScoreOf(grammars[g], by_grammar[g], collar_s));
  if (IsGiven(options, "--json")) {
    context.out << ScoresJson(scores, collar_s).dump(2) << "\n";
  } else {
    for (const score::Score& one : scores) context.out << ScoreTable(one, collar_s) << "\n";
    if (scores.size() > 1) context.out << SideBySide(scores, collar_s) << "\n";
    context.out << "C correct, D deleted, F fragmented, M merged, FM both, I' inserted (Ward et al. 2011); boundary errors "
                   "are\nfound - true: signed median / absolute 95th percentile / largest; late: from an event's end to its "
                   "decision,\nmedian/largest.\n";
  }
  return failed == 0 ? ExitCode::kAgrees : ExitCode::kFailure;
}

}  // namespace

Command ScoreCommand() {
  return {.name = "score",
          .summary = "Score grammars against what physically happened",
          .examples =
              "prehend score\n"
              "prehend score --grammar pick_and_place --grammar my/rules.grammar\n"
              "prehend score 'slide/*' --collar-ms 20 --json",
          .declare = Declare,
          .run = Run};
}

}  // namespace prehend::harness
