// SPDX-License-Identifier: Apache-2.0
// See harness/measure/score/score_scenario.h. Tested by tests/program/score_test.cc
#include "harness/measure/score/score_scenario.h"

#include <algorithm>

#include "harness/episode/episode/open_episode.h"
#include "harness/episode/run/load_grammar.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_text.h"
#include "harness/episode/run/segment.h"
#include "harness/episode/run/validate_claims.h"
#include "harness/truth/claims/judge_claims.h"
#include "harness/truth/oracle/oracle.h"

namespace prehend::measure {
namespace {

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

}  // namespace

tl::expected<std::vector<EpisodeToScore>, ScoreFailure> EpisodesToScore(
    const ScoreRequest& request) {
  const auto unread = [](grammar::Diagnostics why) {
    return tl::unexpected(ScoreFailure{std::move(why)});
  };
  Result<episode::Episode> episode =
      episode::OpenEpisode(request.episode, {request.grammars.front(), {}}, request.root);
  if (!episode) return unread(std::move(episode.error()));
  const Result<episode::RunResult> played = episode->Run(true);
  if (!played) return unread(played.error());
  const scenario::Scenario& scenario = episode->loaded().scenario;
  const episode::RunResult& run = *played;
  if (run.status.kind != physics::RunStatus::Kind::kCompleted) {
    const grammar::Diagnostic failed{
        .file = request.episode.file, .place = {}, .message = episode::StatusText(run)};
    return tl::unexpected(ScoreFailure{.diagnostics = {failed}, .is_bad_input = false});
  }
  const grammar::Tick end = run.ticks + 1;
  std::vector<grammar::Timeline> possible;
  for (const grammar::Timeline& truth :
       truth::PossibleTimelines(scenario.scene, run.recording, end))
    possible.push_back(Scored(truth, request.events));
  std::vector<EpisodeToScore> episodes;
  for (const std::string& name : request.grammars) {
    const grammar::CompileResult compiled =
        episode::LoadGrammar(request.root, name, request.settings);
    if (!compiled.program) return tl::unexpected(ScoreFailure{compiled.diagnostics});
    const grammar::Timeline found =
        episode::Resegment(scenario, run.recording, compiled.program, end);
    EpisodeToScore& one = episodes.emplace_back();
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
  return episodes;
}

}  // namespace prehend::measure
