// SPDX-License-Identifier: Apache-2.0
// See harness/score/score_scenario.h. Tested by tests/program/score_test.cc
#include "harness/score/score_scenario.h"

#include <algorithm>

#include "harness/oracle/oracle.h"
#include "harness/run/load_grammar.h"
#include "harness/run/load_run.h"
#include "harness/run/run_text.h"

namespace prehend::harness {
namespace {

/// Removes events that are not scored, and counts those that the oracle does not define.
void KeepScored(const std::vector<std::string>& wanted, score::EpisodeToScore& episode) {
  const auto is_left_out = [&](const grammar::NamedEvent& event) {
    return !OracleDefines(event.event) ||
           (!wanted.empty() && std::ranges::find(wanted, event.event) == wanted.end());
  };
  for (const grammar::NamedEvent& event : episode.found.events) {
    if (!OracleDefines(event.event)) ++episode.ignored[event.event];
  }
  std::erase_if(episode.truth.events, is_left_out);
  std::erase_if(episode.found.events, is_left_out);
}

}  // namespace

tl::expected<std::vector<score::EpisodeToScore>, ScoreFailure> EpisodesToScore(
    const ScoreRequest& request) {
  const Result<LoadedRun> loaded = LoadRun(
      {.scenario_file = request.scenario_file, .grammar = request.grammars.front()}, request.root);
  if (!loaded) return tl::unexpected(ScoreFailure{loaded.error()});
  const Scenario& scenario = loaded->scenario;
  const RunResult run = RunScenario(scenario, loaded->program, {.record = true});
  if (run.status.kind != physics::RunStatus::Kind::kCompleted) {
    const grammar::Diagnostic failed{
        .file = request.scenario_file, .place = {}, .message = StatusText(run)};
    return tl::unexpected(ScoreFailure{.diagnostics = {failed}, .is_bad_input = false});
  }
  const grammar::Tick end = run.ticks + 1;
  const grammar::Timeline truth = TrueTimeline(scenario.scene, run.recording, end);
  std::vector<score::EpisodeToScore> episodes;
  for (const std::string& name : request.grammars) {
    const grammar::CompileResult compiled = LoadGrammar(request.root, name);
    if (!compiled.program) return tl::unexpected(ScoreFailure{compiled.diagnostics});
    score::EpisodeToScore& episode = episodes.emplace_back();
    episode = {.scenario = request.id,
               .ticks = end,
               .truth = truth,
               .found = Resegment(scenario, run.recording, compiled.program, end),
               .ignored = {}};
    KeepScored(request.events, episode);
  }
  return episodes;
}

}  // namespace prehend::harness
