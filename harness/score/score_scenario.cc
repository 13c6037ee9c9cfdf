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
    if (!OracleDefines(event.event)) ++episode.not_judged[event.event];
  }
  std::erase_if(episode.truth.events, is_left_out);
  std::erase_if(episode.found.events, is_left_out);
}

}  // namespace

ReadResult<std::vector<score::EpisodeToScore>> EpisodesToScore(const ScoreRequest& request,
                                                               bool& bad_input) {
  bad_input = true;
  const ReadResult<LoadedRun> loaded = LoadRun(
      {.scenario_file = request.scenario_file, .grammar = request.grammars.front()}, request.root);
  if (!loaded.value) return {std::nullopt, loaded.diagnostics};
  bad_input = false;
  const Scenario& scenario = loaded.value->scenario;
  const RunResult run = RunScenario(scenario, loaded.value->program, {.record = true});
  if (run.status.kind != physics::RunStatus::Kind::kCompleted) {
    return {std::nullopt,
            {{.file = request.scenario_file,
              .place = {},
              .message = StatusText(run),
              .source_line = {},
              .hint = {}}}};
  }
  const grammar::Tick end = run.ticks + 1;
  const grammar::Timeline truth = TrueTimeline(scenario.scene, run.recording, end);
  std::vector<score::EpisodeToScore> episodes;
  for (const std::string& name : request.grammars) {
    const grammar::CompileResult compiled = LoadGrammar(request.root, name);
    if (!compiled.program) return {std::nullopt, compiled.diagnostics};
    score::EpisodeToScore& episode = episodes.emplace_back();
    episode = {.scenario = request.id,
               .ticks = end,
               .truth = truth,
               .found = Resegment(scenario, run.recording, compiled.program, end),
               .not_judged = {}};
    KeepScored(request.events, episode);
  }
  return {std::move(episodes), {}};
}

}  // namespace prehend::harness
