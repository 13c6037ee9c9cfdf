// SPDX-License-Identifier: Apache-2.0
// See harness/score/score_scenario.h. Tested by tests/program/score_test.cc
#include "harness/score/score_scenario.h"

#include <algorithm>

#include "harness/claims/judge_claims.h"
#include "harness/episode/open_episode.h"
#include "harness/oracle/oracle.h"
#include "harness/run/load_grammar.h"
#include "harness/run/load_run.h"
#include "harness/run/run_text.h"
#include "harness/run/segment.h"
#include "harness/run/validate_claims.h"

namespace prehend::harness {
namespace {

/// Without events that are not scored.
grammar::Timeline Scored(const grammar::Timeline& timeline,
                         const std::vector<std::string>& wanted) {
  grammar::Timeline scored = timeline;
  std::erase_if(scored.events, [&](const grammar::NamedEvent& event) {
    return !OracleDefines(event.event) ||
           (!wanted.empty() && std::ranges::find(wanted, event.event) == wanted.end());
  });
  return scored;
}

/// How often each kind of event was recognised that the oracle does not define.
std::map<std::string, int> Ignored(const grammar::Timeline& found) {
  std::map<std::string, int> counts;
  for (const grammar::NamedEvent& event : found.events) {
    if (!OracleDefines(event.event)) ++counts[event.event];
  }
  return counts;
}

}  // namespace

tl::expected<std::vector<score::EpisodeToScore>, ScoreFailure> EpisodesToScore(
    const ScoreRequest& request) {
  const auto unread = [](grammar::Diagnostics why) {
    return tl::unexpected(ScoreFailure{std::move(why)});
  };
  Result<Episode> episode =
      OpenEpisode(request.episode, {request.grammars.front(), {}}, request.root);
  if (!episode) return unread(std::move(episode.error()));
  const Result<RunResult> played = episode->Run(true);
  if (!played) return unread(played.error());
  const Scenario& scenario = episode->loaded().scenario;
  const RunResult& run = *played;
  if (run.status.kind != physics::RunStatus::Kind::kCompleted) {
    const grammar::Diagnostic failed{
        .file = request.episode.file, .place = {}, .message = StatusText(run)};
    return tl::unexpected(ScoreFailure{.diagnostics = {failed}, .is_bad_input = false});
  }
  const grammar::Tick end = run.ticks + 1;
  std::vector<grammar::Timeline> possible;
  for (const grammar::Timeline& truth : PossibleTimelines(scenario.scene, run.recording, end))
    possible.push_back(Scored(truth, request.events));
  std::vector<score::EpisodeToScore> episodes;
  for (const std::string& name : request.grammars) {
    const grammar::CompileResult compiled = LoadGrammar(request.root, name, request.settings);
    if (!compiled.program) return tl::unexpected(ScoreFailure{compiled.diagnostics});
    const grammar::Timeline found = Resegment(scenario, run.recording, compiled.program, end);
    score::EpisodeToScore& one = episodes.emplace_back();
    one = {.scenario = request.id,
           .ticks = end,
           .truth = possible.front(),
           .found = Scored(found, request.events),
           .ignored = Ignored(found),
           .by_definitions = {},
           .by_claims = score::ByClaims(
               request.id, JudgeClaims(scenario.expects, scenario.file,
                                       ClaimableIn(scenario, *compiled.program), found))};
    one.by_definitions =
        score::ByDefinitions(request.id, possible, one.found, DefaultTolerance(scenario));
  }
  return episodes;
}

}  // namespace prehend::harness
