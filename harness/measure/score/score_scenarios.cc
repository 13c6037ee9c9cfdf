// SPDX-License-Identifier: Apache-2.0
#include "harness/measure/score/score_scenarios.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "grammar/contents.h"
#include "harness/base/base/number_text.h"
#include "harness/base/base/project_paths.h"
#include "harness/base/process/worker_pool.h"
#include "harness/episode/episode/episode.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_text.h"
#include "harness/episode/run/segment_recording.h"
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
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(EpisodeToScore::Bands, begin, end)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(EpisodeToScore, scenario, ticks, truth, found, ignored,
                                   by_definitions, by_claims, failure, notes, covers, cpu_s, bands)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ScenarioOnWire, episodes, problem, is_bad_input)

namespace {

constexpr double kTimeLimit_s = 300;

/// Without events that are not scored.
grammar::Timeline Scored(const grammar::Timeline& timeline,
                         const std::vector<std::string>& wanted) {
  grammar::Timeline scored = timeline;
  std::erase_if(scored.events, [&](const grammar::NamedEvent& event) {
    return !truth::OracleDefines(event) || std::ranges::count(wanted, event.event) == 0;
  });
  return scored;
}

/// How often each kind of event was recognised that the oracle does not define.
std::map<std::string, int> Ignored(const grammar::Timeline& found) {
  std::map<std::string, int> counts;
  for (const grammar::NamedEvent& event : found.events) {
    if (!truth::OracleDefines(event)) ++counts[event.event];
  }
  return counts;
}

/// All roles of the events that the oracle defines.
exchange::ComparedRoles JudgedRoles(const grammar::Program& program) {
  exchange::ComparedRoles roles;
  for (const grammar::EventSignature& event : grammar::EventSignatures(program))
    if (truth::OracleDefines(event.name, event.roles.empty() ? "" : event.roles.front()))
      roles[event.name] = event.roles;
  return roles;
}

/// What a source finds.
Result<grammar::Timeline> Find(const ScoreRequest& request, const Source& source,
                               episode::Episode& episode, EpisodeToScore& one) {
  const bool is_grammar = source.kind == Source::Kind::kGrammar;
  const std::string whose = is_grammar ? source.text : request.asking->WhoseEvents();
  const grammar::CompileResult compiled =
      episode::LoadGrammar(request.root, whose.empty() ? kDefaultGrammar : whose, request.settings);
  if (!compiled.program) return tl::unexpected(compiled.diagnostics);
  if (!is_grammar)
    return Foreign(*request.asking, source)
        .Find(episode::TakesOf({request.episode}), 0, Watched(episode), *compiled.program,
              JudgedRoles(*compiled.program), one);
  Result<grammar::Timeline> found = episode.Segment(compiled.program);
  const scenario::Scenario& scenario = episode.loaded().scenario;
  if (found)
    one.by_claims = ByClaims(
        request.id, truth::JudgeClaims(scenario.expects, scenario.file,
                                       episode::ClaimableIn(scenario, *compiled.program), *found));
  return found;
}

/// Of each event of the first timeline the bands of its boundaries: those of the events of the
/// others with its label that overlap it.
std::vector<EpisodeToScore::Bands> BandsOf(const std::vector<grammar::Timeline>& possible) {
  std::vector<EpisodeToScore::Bands> bands;
  for (const grammar::NamedEvent& event : possible.front().events) {
    const auto [begin, end] = event.interval;
    EpisodeToScore::Bands& band = bands.emplace_back();
    band = {.begin = {begin, begin}, .end = {end, end}};
    for (const grammar::Timeline& other : possible)
      for (const grammar::NamedEvent& same : other.events) {
        const auto [from, to] = same.interval;
        if (same.event != event.event || from >= end || to <= begin ||
            same.Label() != event.Label())
          continue;
        band.begin = {std::min(band.begin.begin, from), std::max(band.begin.end, from)};
        band.end = {std::min(band.end.begin, to), std::max(band.end.end, to)};
      }
  }
  return bands;
}

/// One episode per source, all with the same truth: who does not define a kind of event, or
/// misspells it, has missed all such events.
ScenarioOnWire Played(const ScoreRequest& request) {
  const auto unread = [](const grammar::Diagnostics& why) {
    return ScenarioOnWire{.problem = grammar::Format(why), .is_bad_input = true};
  };
  Result<episode::Episode> episode =
      episode::OpenEpisode(request.episode, {request.asking->WhoseEvents(), {}}, request.root);
  if (!episode) return unread(episode.error());
  const scenario::Scenario& scenario = episode->loaded().scenario;
  const episode::RunResult& run = episode->Played();
  if (run.status.kind != physics::RunStatus::Kind::kCompleted)
    return {.problem = grammar::Format(grammar::Diagnostic{.file = request.episode.file,
                                                           .message = episode::StatusText(run)}),
            .is_bad_input = run.recording.empty()};
  const grammar::Tick end = run.ticks + 1;
  std::vector<grammar::Timeline> possible;
  for (const grammar::Timeline& truth :
       truth::PossibleTimelines(scenario.scene, run.recording, end))
    possible.push_back(Scored(truth, request.events));
  ScenarioOnWire sent;
  const std::vector<EpisodeToScore::Bands> bands = BandsOf(possible);
  for (const Source& source : request.asking->sources) {
    EpisodeToScore& one = sent.episodes.emplace_back();
    one = {.scenario = request.id, .ticks = end, .truth = possible.front(), .bands = bands};
    const Result<grammar::Timeline> found = Find(request, source, *episode, one);
    if (!found) return unread(found.error());
    one.found = Scored(*found, request.events);
    one.ignored.merge(Ignored(*found));
    if (one.failure.empty())
      one.by_definitions =
          ByDefinitions(request.id, possible, one.found, scenario::DefaultTolerance(scenario));
  }
  return sent;
}

/// Of the judged events those that are not there.
std::vector<std::string> SilentOf(const std::vector<std::string>& events,
                                  const std::function<bool(const std::string&)>& has) {
  std::vector<std::string> silent;
  for (const std::string& event : events)
    if (!has(event)) silent.push_back(event);
  return silent;
}

/// Episodes by source.
std::vector<std::vector<EpisodeToScore>> PlayAll(const std::vector<ScoreRequest>& requests,
                                                 const Asking& asking, int jobs,
                                                 std::vector<NotScored>& not_scored) {
  double time_limit_s = kTimeLimit_s;
  for (const Source& source : asking.sources)
    if (source.kind == Source::Kind::kProgram) time_limit_s += asking.time_limit_s + kTimeLimit_s;
  std::vector<WorkerJob> plays;
  for (const ScoreRequest& request : requests)
    plays.push_back([&request] { return ToWire(Played(request)); });
  const std::vector<WorkerResult> results =
      RunInWorkers(plays, {.jobs = jobs, .time_limit_s = time_limit_s});
  std::vector<std::vector<EpisodeToScore>> by_grammar(asking.sources.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    ScenarioOnWire sent{.problem = results[i].reason + "\n"};
    if (results[i].finished) sent = FromWire<ScenarioOnWire>(results[i].output);
    if (!sent.problem.empty())
      not_scored.push_back({requests[i].id, sent.problem, sent.is_bad_input});
    for (std::size_t g = 0; sent.problem.empty() && g < sent.episodes.size(); ++g)
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
  for (const std::string& list : lists)
    std::ranges::move(SplitAt(list, ','), std::back_inserter(names));
  return names;
}

std::string UnknownEvent(const std::vector<std::string>& events) {
  std::vector<std::string> known(truth::OracleEvents().begin(), truth::OracleEvents().end());
  known.insert(known.end(), truth::FurnitureEvents().begin(), truth::FurnitureEvents().end());
  for (const std::string& event : events) {
    if (std::ranges::count(known, event) > 0) continue;
    if (event.empty()) return "--event: a name is missing next to a comma; write NAME,NAME";
    const std::string near = grammar::NearestName(event, known);
    return fmt::format("--event: docs/events.md defines no '{}'; {}", event,
                       near.empty() ? fmt::format("it defines {}", fmt::join(known, ", "))
                                    : fmt::format("did you mean '{}'?", near));
  }
  return "";
}

Result<ToScore> CompileToScore(const std::string& root, const std::vector<Source>& sources,
                               const grammar::Overrides& settings,
                               const std::vector<std::string>& events) {
  ToScore to_score{.events = events, .not_covered = NotCovered(sources.size())};
  std::vector<exchange::ComparedRoles> judged(sources.size());
  for (std::size_t i = 0; i < sources.size(); ++i) {
    if (sources[i].kind != Source::Kind::kGrammar) continue;
    const grammar::CompileResult compiled = episode::LoadGrammar(root, sources[i].text, settings);
    if (!compiled.program) return tl::unexpected(compiled.diagnostics);
    judged[i] = JudgedRoles(*compiled.program);
  }
  if (events.empty()) {
    to_score.events.assign(truth::OracleEvents().begin(), truth::OracleEvents().end());
    for (const std::string_view name : truth::FurnitureEvents())
      if (const std::string event(name);
          std::ranges::any_of(judged, [&](const auto& roles) { return roles.contains(event); }))
        to_score.events.push_back(event);
  }
  for (std::size_t i = 0; i < sources.size(); ++i)
    if (sources[i].kind == Source::Kind::kGrammar)
      to_score.not_covered[i] = SilentOf(
          to_score.events, [&](const std::string& event) { return judged[i].contains(event); });
  return to_score;
}

ScenarioScores ScoreScenarios(const std::vector<ScoreRequest>& requests, const Asking& asking,
                              const NotCovered& not_covered, double collar_s, int jobs) {
  ScenarioScores scores;
  auto by_source = PlayAll(requests, asking, jobs, scores.not_scored);
  if (by_source.front().empty()) return scores;
  std::vector<std::vector<EpisodeToScore>> scored;
  for (std::size_t s = 0; s < by_source.size(); ++s) {
    std::vector<EpisodeToScore>& episodes = by_source[s];
    const std::string& name = asking.sources[s].text;
    std::vector<std::string> covers;
    for (const EpisodeToScore& one : episodes) {
      scores.notes += one.notes;
      if (!one.covers.empty()) covers = one.covers;
      if (!one.failure.empty())
        scores.not_scored.push_back({fmt::format("{} by {}", one.scenario, name), one.failure});
    }
    if (std::ranges::none_of(episodes, [](const auto& one) { return one.failure.empty(); }))
      continue;
    Score& score = scores.of_grammars.emplace_back(ScoreOf(name, episodes, collar_s));
    score.not_covered = not_covered[s];
    if (asking.label_map.empty() && !covers.empty())
      score.not_covered = SilentOf(requests.front().events, [&](const std::string& event) {
        return std::ranges::count(covers, event) > 0;
      });
    scored.push_back(std::move(episodes));
  }
  scores.evaluators = EvaluatorsOf(scored);
  return scores;
}

std::string ScenarioScoresText(const ScenarioScores& scores, bool all_differences) {
  std::vector<std::string> names;
  for (const Score& score : scores.of_grammars) names.push_back(score.grammar);
  return ScoresText(scores.of_grammars) + "\n" + EvaluatorTable(names, scores.evaluators) + "\n" +
         DifferencesText(names, scores.evaluators, all_differences);
}

}  // namespace prehend::measure
