// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/episodes/record_episode.h"

#include "harness/episode/episodes/database.h"
#include "harness/episode/episodes/schema.h"
#include "harness/episode/episodes/task_files.h"
#include "harness/episode/episodes/write_rows.h"
#include "harness/episode/frames/chunk.h"
#include "harness/episode/run/run_trials.h"
#include "harness/episode/sense/entity_table.h"

namespace prehend::episode {

namespace {

const char* EngineName(physics::Engine engine) {
  switch (engine) {
    case physics::Engine::kBullet:
      return "bullet";
    case physics::Engine::kBox2d:
      return "box2d";
    case physics::Engine::kBulletStock:
      return "bullet_stock";
  }
  return "";
}

NewTask TaskOf(const RecordRequest& request, const scenario::Scenario& scenario) {
  return {.files = PackTask(request.run, request.files, request.root),
          .scenario = ScenarioId(scenario.skill, scenario.name),
          .shows = scenario.shows,
          .entities = MakeEntityTable(scenario)};
}

NewEpisode EpisodeOf(const RecordRequest& request, const scenario::Scenario& scenario) {
  return {.grammar = scenario.grammar,
          .ticks_per_second = scenario.scene.world.rate_hz,
          .engine = EngineName(scenario.scene.world.engine),
          .seed = static_cast<std::int64_t>(scenario.scene.world.seed),
          .program_hash = request.program_hash,
          .recorded_on = request.recorded_on};
}

}  // namespace

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

struct EpisodeRecorder::State {
  Database database;
  const scenario::Scenario& scenario;
  std::int64_t episode;
  ChunkWriter writer;
  ChunkRows rows;

  State(Database opened, const scenario::Scenario& played, std::int64_t id)
      : database(std::move(opened)),
        scenario(played),
        episode(id),
        writer(LayoutOf(played.scene)),
        rows(database, id) {}
};

EpisodeRecorder::EpisodeRecorder(const RecordRequest& request, const scenario::Scenario& scenario)
    : file_(request.file) {
  problem_ = ProblemOf(file_, [&] {
    Database database = OpenToWrite(request.file);
    Transaction transaction(database);
    const std::int64_t task = WriteTask(database, TaskOf(request, scenario));
    const std::int64_t episode = WriteEpisode(database, task, EpisodeOf(request, scenario));
    transaction.Commit();
    state_ = std::make_unique<State>(std::move(database), scenario, episode);
  });
}

EpisodeRecorder::~EpisodeRecorder() = default;
EpisodeRecorder::EpisodeRecorder(EpisodeRecorder&&) noexcept = default;

void EpisodeRecorder::Add(const physics::Snapshot& snapshot) {
  if (!problem_.empty()) return;
  state_->writer.Add(snapshot);
  if (state_->writer.IsFull()) WriteChunk();
}

void EpisodeRecorder::WriteChunk() {
  State& state = *state_;
  const Chunk chunk = state.writer.Take();
  problem_ = ProblemOf(file_, [&] {
    Transaction transaction(state.database);
    state.rows.Write(chunk);
    transaction.Commit();
  });
}

void EpisodeRecorder::Finish(const RunResult& run) {
  if (problem_.empty() && state_->writer.frames() > 0) WriteChunk();
  if (!problem_.empty()) return;
  State& state = *state_;
  const bool completed = run.status.kind == physics::RunStatus::Kind::kCompleted;
  problem_ = ProblemOf(file_, [&] {
    Transaction transaction(state.database);
    WriteEnd(state.database, state.episode, completed ? kCompleted : kFailed, run,
             MakeEntityTable(state.scenario));
    transaction.Commit();
  });
}

std::string WhyNotRecordable(const std::string& file) {
  return ProblemOf(file, [&] { (void)OpenToWrite(file); });
}

}  // namespace prehend::episode
