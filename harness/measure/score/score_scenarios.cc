// SPDX-License-Identifier: Apache-2.0
#include "harness/measure/score/score_scenarios.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "grammar/contents.h"
#include "harness/base/process/wire.h"
#include "harness/base/process/worker_pool.h"
#include "harness/episode/episode/open_episode.h"
#include "harness/episode/run/load_grammar.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_text.h"
#include "harness/episode/run/segment.h"
#include "harness/episode/run/validate_claims.h"
#include "harness/truth/claims/judge_claims.h"
#include "harness/truth/oracle/oracle.h"
#include "harness/truth/timeline/timeline_wire.h"

namespace prehend::measure {

/// What a worker sends: an episode for each grammar, or why there are none.
struct ScenarioOnWire {
  std::vector<EpisodeToScore> episodes;
  std::string problem;
  bool is_bad_input = false;
};

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Confirmed, of, confirmed)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Evaluation, by_event, differences)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(EpisodeToScore, scenario, ticks, truth, found, ignored,
                                   by_definitions, by_claims)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ScenarioOnWire, episodes, problem, is_bad_input)

namespace {

constexpr double kTimeLimit_s = 300;

/// Without events that are not scored.
grammar::Timeline Scored(const grammar::Timeline& timeline,
                         const std::vector<std::string>& wanted) {
  grammar::Timeline scored = timeline;
  std::erase_if(scored.events, [&](const grammar::NamedEvent& event) {
    return !truth::OracleDefines(event.event) ||
           (!wanted.empty() && std::ranges::find(wanted, event.event) == wanted.end());
  });
  return scored;
}

/// How often each kind of event was recognised that the oracle does not define.
std::map<std::string, int> Ignored(const grammar::Timeline& found) {
  std::map<std::string, int> counts;
  for (const grammar::NamedEvent& event : found.events) {
    if (!truth::OracleDefines(event.event)) ++counts[event.event];
  }
  return counts;
}

/// One episode per grammar, all with the same truth: a grammar that does not define a kind of
/// event, or misspells it, has missed all such events.
ScenarioOnWire Played(const ScoreRequest& request) {
  const auto unread = [](const grammar::Diagnostics& why) {
    return ScenarioOnWire{.problem = grammar::Format(why), .is_bad_input = true};
  };
  Result<episode::Episode> episode =
      episode::OpenEpisode(request.episode, {request.grammars.front(), {}}, request.root);
  if (!episode) return unread(episode.error());
  const Result<episode::RunResult> played = episode->Run(true);
  if (!played) return unread(played.error());
  const scenario::Scenario& scenario = episode->loaded().scenario;
  const episode::RunResult& run = *played;
  if (run.status.kind != physics::RunStatus::Kind::kCompleted)
    return {.problem = grammar::Format(grammar::Diagnostic{
                .file = request.episode.file, .place = {}, .message = episode::StatusText(run)})};
  const grammar::Tick end = run.ticks + 1;
  std::vector<grammar::Timeline> possible;
  for (const grammar::Timeline& truth :
       truth::PossibleTimelines(scenario.scene, run.recording, end))
    possible.push_back(Scored(truth, request.events));
  ScenarioOnWire sent;
  for (const std::string& name : request.grammars) {
    const grammar::CompileResult compiled =
        episode::LoadGrammar(request.root, name, request.settings);
    if (!compiled.program) return unread(compiled.diagnostics);
    const grammar::Timeline found =
        episode::Resegment(scenario, run.recording, compiled.program, end);
    EpisodeToScore& one = sent.episodes.emplace_back();
    one = {.scenario = request.id,
           .ticks = end,
           .truth = possible.front(),
           .found = Scored(found, request.events),
           .ignored = Ignored(found),
           .by_definitions = {},
           .by_claims = ByClaims(
               request.id,
               truth::JudgeClaims(scenario.expects, scenario.file,
                                  episode::ClaimableIn(scenario, *compiled.program), found))};
    one.by_definitions =
        ByDefinitions(request.id, possible, one.found, scenario::DefaultTolerance(scenario));
  }
  return sent;
}

/// Of the judged events those that no rule of the grammar prints.
std::vector<std::string> NotCovered(const grammar::Program& program,
                                    const std::vector<std::string>& events) {
  std::vector<std::string> silent;
  for (const std::string_view event : truth::OracleEvents()) {
    const bool judged = events.empty() || std::ranges::find(events, event) != events.end();
    if (judged && !HasEvent(program, event)) silent.emplace_back(event);
  }
  return silent;
}

/// Episodes by grammar.
std::vector<std::vector<EpisodeToScore>> PlayAll(const std::vector<ScoreRequest>& requests,
                                                 std::size_t grammars, int jobs,
                                                 std::vector<NotScored>& not_scored) {
  std::vector<WorkerJob> plays;
  for (const ScoreRequest& request : requests)
    plays.push_back([&request] { return ToWire(Played(request)); });
  const std::vector<WorkerResult> results =
      RunInWorkers(plays, {.jobs = jobs, .time_limit_s = kTimeLimit_s});
  std::vector<std::vector<EpisodeToScore>> by_grammar(grammars);
  for (std::size_t i = 0; i < results.size(); ++i) {
    ScenarioOnWire sent{.problem = results[i].reason + "\n"};
    if (results[i].finished) sent = FromWire<ScenarioOnWire>(results[i].output);
    if (!sent.problem.empty())
      not_scored.push_back({requests[i].id, sent.problem, sent.is_bad_input});
    for (std::size_t g = 0; g < sent.episodes.size(); ++g)
      by_grammar[g].push_back(std::move(sent.episodes[g]));
  }
  return by_grammar;
}

/// What the definitions and the claims say of the episodes.
std::vector<Evaluator> EvaluatorsOf(const std::vector<std::vector<EpisodeToScore>>& by_grammar) {
  Evaluator definitions{"definitions", "events lie within the bands of docs/events.md", {}};
  Evaluator claims{"claims", "a run shows what its author said before it was played", {}};
  for (const std::vector<EpisodeToScore>& episodes : by_grammar) {
    Evaluation &defined = definitions.of_grammars.emplace_back(),
               &claimed = claims.of_grammars.emplace_back();
    for (const EpisodeToScore& episode : episodes) {
      defined += episode.by_definitions;
      claimed += episode.by_claims;
    }
  }
  return {std::move(definitions), std::move(claims)};
}

/// What differs, by grammar; of many differences the first ones.
std::string DifferencesText(const std::vector<std::string>& grammars,
                            const std::vector<Evaluator>& evaluators, bool all) {
  constexpr std::size_t kMaxShown = 10;
  std::string text;
  for (const Evaluator& evaluator : evaluators) {
    for (std::size_t g = 0; g < grammars.size(); ++g) {
      const std::vector<std::string>& lines = evaluator.of_grammars[g].differences;
      const std::size_t shown = all ? lines.size() : std::min(lines.size(), kMaxShown);
      if (shown > 0) text += fmt::format("{}, outside the {}:\n", grammars[g], evaluator.name);
      for (std::size_t i = 0; i < shown; ++i) text += "  " + lines[i] + "\n";
      if (shown < lines.size())
        text += fmt::format("  and {} more; --verbose lists all\n", lines.size() - shown);
    }
  }
  return text;
}

}  // namespace

std::vector<std::string> EventsIn(const std::vector<std::string>& lists) {
  std::vector<std::string> names;
  for (const std::string& list : lists) {
    for (std::size_t begin = 0; begin <= list.size();) {
      const std::size_t end = std::min(list.find(',', begin), list.size());
      names.push_back(list.substr(begin, end - begin));
      begin = end + 1;
    }
  }
  return names;
}

std::string UnknownEvent(const std::vector<std::string>& events) {
  const std::vector<std::string> known(truth::OracleEvents().begin(), truth::OracleEvents().end());
  for (const std::string& event : events) {
    if (truth::OracleDefines(event)) continue;
    if (event.empty()) return "--event: a name is missing next to a comma; write NAME,NAME";
    const std::string near = grammar::NearestName(event, known);
    return fmt::format("--event: docs/events.md defines no '{}'; {}", event,
                       near.empty() ? fmt::format("it defines {}", fmt::join(known, ", "))
                                    : fmt::format("did you mean '{}'?", near));
  }
  return "";
}

Result<ScoredGrammars> CompileToScore(const std::string& root,
                                      const std::vector<std::string>& names,
                                      const grammar::Overrides& settings,
                                      const std::vector<std::string>& events) {
  ScoredGrammars grammars{.names = names};
  for (const std::string& name : names) {
    const grammar::CompileResult compiled = episode::LoadGrammar(root, name, settings);
    if (!compiled.program) return tl::unexpected(compiled.diagnostics);
    grammars.not_covered.push_back(NotCovered(*compiled.program, events));
  }
  return grammars;
}

ScenarioScores ScoreScenarios(const std::vector<ScoreRequest>& requests,
                              const ScoredGrammars& grammars, double collar_s, int jobs) {
  ScenarioScores scores;
  const auto by_grammar = PlayAll(requests, grammars.names.size(), jobs, scores.not_scored);
  if (by_grammar.front().empty()) return scores;
  for (std::size_t g = 0; g < by_grammar.size(); ++g) {
    scores.of_grammars.push_back(ScoreOf(grammars.names[g], by_grammar[g], collar_s));
    scores.of_grammars.back().not_covered = grammars.not_covered[g];
  }
  scores.evaluators = EvaluatorsOf(by_grammar);
  return scores;
}

std::string ScenarioScoresText(const ScenarioScores& scores, double collar_s,
                               bool all_differences) {
  std::vector<std::string> names;
  for (const Score& score : scores.of_grammars) names.push_back(score.grammar);
  return ScoresText(scores.of_grammars, collar_s) + "\n" +
         EvaluatorTable(names, scores.evaluators) + "\n" +
         DifferencesText(names, scores.evaluators, all_differences);
}

}  // namespace prehend::measure
