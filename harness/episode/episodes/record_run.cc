// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/episodes/record_run.h"

#include "harness/episode/episodes/schema.h"
#include "harness/episode/run/outcome.h"
#include "harness/episode/sense/entity_table.h"

namespace prehend::episode {

RunRecorder::RunRecorder(const RecordRequest& request, const scenario::Scenario& scenario) {
  if (IsEpisodeFile(request.file)) {
    episode_.emplace(request, scenario);
    return;
  }
  file_.emplace(request.file);
  problem_ = file_->problem();
  if (problem_.empty())
    lines_.emplace(file_->stream(), EpisodeHeader{.episode = scenario.name,
                                                  .grammar = scenario.grammar,
                                                  .entity_table = MakeEntityTable(scenario)});
}

void RunRecorder::Add(ScenarioRun& playing) {
  if (lines_ && playing.sensed()) lines_->Write(playing.frame());
  if (episode_) episode_->Add(playing.snapshot());
}

void RunRecorder::Finish(const RunResult& run) {
  if (episode_) return episode_->Finish(run);
  lines_->Finish(run.ticks + 1);
  problem_ = file_->Commit();
}

RunResult PlayScenario(const LoadedRun& loaded, const RunOptions& how, RunRecorder* recorder) {
  const scenario::Scenario& scenario = loaded.scenario;
  OutcomeWatch outcomes(scenario.scene, scenario.outcomes);
  ScenarioRun playing(scenario, loaded.program, how);
  while (playing.Step()) {
    outcomes.Look(playing.snapshot());
    if (recorder) recorder->Add(playing);
  }
  RunResult run = playing.Finish();
  if (!scenario.outcomes.empty() && run.status.kind == physics::RunStatus::Kind::kCompleted)
    run.outcome = outcomes.Judge(playing.snapshot());
  if (recorder) recorder->Finish(run);
  return run;
}

TrialResult RecordTrial(int trial, const RunRequest& varied, RecordRequest request) {
  const Result<LoadedRun> loaded = LoadRun(varied, request.root, &request.files);
  if (!loaded) return {trial, "failed", grammar::Format(loaded.error()), {}};
  request.run = varied;
  RunRecorder recorder(request, loaded->scenario);
  const RunResult run = PlayScenario(*loaded, {}, &recorder);
  const bool completed = run.status.kind == physics::RunStatus::Kind::kCompleted;
  return {trial, completed ? run.outcome : "failed",
          completed ? "" : run.status.entity + ": " + run.status.reason, recorder.problem()};
}

}  // namespace prehend::episode
