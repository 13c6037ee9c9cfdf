// SPDX-License-Identifier: Apache-2.0
// See harness/score/score_scenario.h. Tested by tests/program/score_test.cc
#include "harness/score/score_scenario.h"

#include <algorithm>

#include "grammar/base/check.h"
#include "harness/claims/judge_claims.h"
#include "harness/episodes/load_episode.h"
#include "harness/oracle/oracle.h"
#include "harness/run/load_grammar.h"
#include "harness/run/load_run.h"
#include "harness/run/run_text.h"
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

struct Played {
  LoadedRun loaded;
  RunResult run;
};

/// The scenario, simulated; or the episode, read.
Result<Played> PlayOrRead(const ScoreRequest& request) {
  if (request.episode == 0) {
    Result<LoadedRun> loaded =
        LoadRun({.scenario_file = request.scenario_file, .grammar = request.grammars.front()},
                request.root);
    if (!loaded) return tl::unexpected(std::move(loaded.error()));
    RunResult run = RunScenario(loaded->scenario, loaded->program, {.record = true});
    return Played{std::move(*loaded), std::move(run)};
  }
  const auto file = episodes::EpisodeFile::Open(request.scenario_file);
  if (!file) return tl::unexpected(file.error());
  const auto row = std::ranges::find(file->episodes(), request.episode, &episodes::EpisodeRow::id);
  PREHEND_CHECK(row != file->episodes().end());
  if (!row->simulated)
    return tl::unexpected(grammar::Diagnostics{
        {.file = request.scenario_file,
         .place = {},
         .message = row->scenario + " was not simulated, so its physical truth is not known",
         .source_line = {},
         .hint = "score it against labels by people: --truth (docs/labels.md)"}});
  Result<LoadedRun> loaded =
      episodes::EpisodeLoader(request.root).Load(*file, *row, {request.grammars.front(), {}});
  if (!loaded) return tl::unexpected(std::move(loaded.error()));
  Result<RunResult> run = episodes::Replay(*file, *row, *loaded);
  if (!run) return tl::unexpected(std::move(run.error()));
  return Played{std::move(*loaded), std::move(*run)};
}

}  // namespace

tl::expected<std::vector<score::EpisodeToScore>, ScoreFailure> EpisodesToScore(
    const ScoreRequest& request) {
  const Result<Played> played = PlayOrRead(request);
  if (!played) return tl::unexpected(ScoreFailure{played.error()});
  const Scenario& scenario = played->loaded.scenario;
  const RunResult& run = played->run;
  if (run.status.kind != physics::RunStatus::Kind::kCompleted) {
    const grammar::Diagnostic failed{
        .file = request.scenario_file, .place = {}, .message = StatusText(run)};
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
    score::EpisodeToScore& episode = episodes.emplace_back();
    episode = {.scenario = request.id,
               .ticks = end,
               .truth = possible.front(),
               .found = Scored(found, request.events),
               .ignored = Ignored(found),
               .by_definitions = {},
               .by_claims = score::ByClaims(
                   request.id, JudgeClaims(scenario.expects, scenario.file,
                                           ClaimableIn(scenario, *compiled.program), found))};
    episode.by_definitions =
        score::ByDefinitions(request.id, possible, episode.found, DefaultTolerance(scenario));
  }
  return episodes;
}

}  // namespace prehend::harness
