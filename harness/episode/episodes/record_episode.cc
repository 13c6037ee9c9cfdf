// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/episodes/record_episode.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "harness/base/base/content_hash.h"
#include "harness/episode/episodes/database.h"
#include "harness/episode/run/run_text.h"
#include "harness/episode/sense/episode_format.h"

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
          .recorded_on = request.recorded_on,
          .uuid = request.uuid};
}

void WriteEntities(const Database& database, std::int64_t task, const std::string& uuid,
                   const grammar::EntityTable& table) {
  Statement insert = database.Prepare("INSERT INTO entity VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  Statement insert_class = database.Prepare("INSERT INTO entity_class VALUES(?, ?, ?, ?)");
  for (std::size_t i = 0; i < table.entities.size(); ++i) {
    const grammar::EntityInfo& entity = table.entities[i];
    const auto number = static_cast<std::int64_t>(i);
    insert.Bind(task).Bind(number).Bind(UuidOf(uuid + entity.name)).Bind(entity.name);
    insert.Bind(entity.classes.front());
    if (entity.part_of == grammar::kNoEntity)
      insert.BindNothing();
    else
      insert.Bind(entity.part_of);
    if (entity.mass_kg > 0)
      insert.Bind(entity.mass_kg);
    else
      insert.BindNothing();
    for (int axis = 0; axis < 3; ++axis) insert.Bind(2 * entity.half_size_m[axis]);
    insert.Run();
    for (std::size_t depth = 0; depth < entity.classes.size(); ++depth) {
      insert_class.Bind(task).Bind(number).Bind(static_cast<std::int64_t>(depth));
      insert_class.Bind(entity.classes[depth]).Run();
    }
  }
}

void WriteEvents(const Database& database, std::int64_t episode, const grammar::EntityTable& table,
                 const grammar::Timeline& timeline) {
  std::map<std::string, std::int64_t> numbers;
  for (std::size_t i = 0; i < table.entities.size(); ++i)
    numbers.try_emplace(table.entities[i].name, static_cast<std::int64_t>(i));
  const auto seconds = [&](grammar::Tick ticks) {
    return truth::SecondsOf(ticks, timeline.ticks_per_second);
  };
  Statement insert = database.Prepare(
      "INSERT INTO event(episode, event, begin_tick, end_tick, decided_tick, open_end, begin_s, "
      "end_s, duration_s) VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?)");
  Statement insert_role = database.Prepare("INSERT INTO event_role VALUES(?, ?, ?, ?, ?)");
  Statement insert_value = database.Prepare("INSERT INTO event_value VALUES(?, ?, ?, ?, ?)");
  for (const grammar::NamedEvent& event : timeline.events) {
    const grammar::Interval& when = event.interval;
    insert.Bind(episode).Bind(event.event).Bind(when.begin).Bind(when.end).Bind(event.decided);
    insert.Bind(event.open_end ? 1 : 0).Bind(seconds(when.begin)).Bind(seconds(when.end));
    insert.Bind(seconds(when.end - when.begin)).Run();
    const std::int64_t row = database.LastRow();
    for (std::size_t i = 0; i < event.roles.size(); ++i) {
      const grammar::Role& role = event.roles[i];
      insert_role.Bind(row).Bind(static_cast<std::int64_t>(i)).Bind(role.name).Bind(role.value);
      const auto entity = numbers.find(role.value);
      if (entity == numbers.end())
        insert_role.BindNothing();
      else
        insert_role.Bind(entity->second);
      insert_role.Run();
    }
    for (std::size_t i = 0; i < event.values.size(); ++i) {
      const grammar::NamedValue& value = event.values[i];
      insert_value.Bind(row).Bind(static_cast<std::int64_t>(i)).Bind(value.name);
      insert_value.Bind(value.value).Bind(value.unit).Run();
    }
  }
}

}  // namespace

RunRecorder::RunRecorder(const RecordRequest& request, const LoadedRun& loaded) {
  const scenario::Scenario& scenario = loaded.scenario;
  if (IsEpisodeFile(request.file)) {
    episode_.emplace(request, scenario);
    return;
  }
  file_.emplace(request.file);
  problem_ = file_->problem();
  if (problem_.empty())
    lines_.emplace(file_->stream(), EpisodeHeader{.episode = scenario.name,
                                                  .grammar = NameToRecord(loaded),
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

TrialResult RecordTrial(int trial, const LoadedRun& loaded, const RecordRequest& request) {
  RunRecorder recorder(request, loaded);
  const RunResult run = PlayScenario(loaded, {}, &recorder);
  const bool completed = run.status.kind == physics::RunStatus::Kind::kCompleted;
  return {trial, completed ? run.outcome : "failed",
          completed ? "" : run.status.entity + ": " + run.status.reason, recorder.problem()};
}

struct EpisodeRecorder::State {
  Database database;
  const scenario::Scenario& scenario;
  std::int64_t episode;
  std::string uuid;
  ChunkWriter writer;
  ChunkRows rows;

  State(Database opened, const scenario::Scenario& played, std::int64_t id, std::string its_uuid)
      : database(std::move(opened)),
        scenario(played),
        episode(id),
        uuid(std::move(its_uuid)),
        writer(LayoutOf(played.scene)),
        rows(database, id) {}

  /// Where locks do nothing, another process may have taken its row.
  void CheckIsOwn() const {
    Statement own = database.Prepare("SELECT 1 FROM episode WHERE id = ? AND uuid = ?");
    if (!own.Bind(episode).Bind(uuid).Step())
      throw DatabaseError("another process has removed the episode that was written");
  }
};

EpisodeRecorder::EpisodeRecorder(const RecordRequest& request, const scenario::Scenario& scenario)
    : file_(request.file) {
  problem_ = ProblemOf(file_, [&] {
    Database database = OpenToWrite(request.file);
    Transaction transaction(database);
    const std::int64_t task = WriteTask(database, TaskOf(request, scenario));
    NewEpisode begun = EpisodeOf(request, scenario);
    if (begun.uuid.empty()) begun.uuid = NewUuid();
    const std::int64_t episode = WriteEpisode(database, task, begun);
    transaction.Commit();
    state_ = std::make_unique<State>(std::move(database), scenario, episode, begun.uuid);
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
    state.CheckIsOwn();
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
    state.CheckIsOwn();
    WriteEnd(state.database, state.episode, completed ? kCompleted : kFailed, run,
             MakeEntityTable(state.scenario));
    transaction.Commit();
  });
}

tl::expected<WriteLock, std::string> LockToRecord(const std::string& file, Writer writer) {
  WriteLock lock;
  const std::string problem = ProblemOf(file, [&] {
    if (writer != Writer::kReplaces) (void)OpenToWrite(file);
    bool is_other = true;
    for (int tries = 100; is_other; --tries) {
      const int locked = open(file.c_str(), O_RDWR | O_CLOEXEC);
      if (locked < 0) return;  // there is none to replace
      lock = WriteLock(nullptr, [locked](void*) { close(locked); });
      // Of the open file, so that workers have it, and of a byte that SQLite does not lock.
      const short type = writer == Writer::kAdds ? F_RDLCK : F_WRLCK;
      struct flock byte = {.l_type = type, .l_start = std::int64_t{1} << 61, .l_len = 1};
      const bool taken = fcntl(locked, F_OFD_SETLK, &byte) != 0 && errno == EAGAIN;
      struct stat opened = {}, named = {};
      const bool replaced = fstat(locked, &opened) != 0 || stat(file.c_str(), &named) != 0 ||
                            opened.st_ino != named.st_ino;
      is_other = taken || replaced;
      if (tries == 0) throw DatabaseError("another process is writing this file");
      if (is_other) usleep(10'000);  // workers of one that was killed may still be dying
    }
  });
  if (problem.empty()) return lock;
  std::error_code error;  // what got no room for its tables is no file
  if (std::filesystem::is_regular_file(file, error) && std::filesystem::is_empty(file, error))
    std::filesystem::remove(file, error);
  return tl::unexpected(problem);
}

void CheckTaskBytes(std::size_t bytes) {
  constexpr std::size_t kMost = std::size_t{1} << 28;
  if (bytes > kMost)
    throw DatabaseError(
        fmt::format("the files of a task have more than {} MiB in all", kMost >> 20));
}

std::int64_t WriteTask(const Database& database, const NewTask& task) {
  const TaskFiles& files = task.files;
  const std::string uuid = UuidOf(task.scenario + "\n" + files.Identity());
  Statement find = database.Prepare("SELECT id FROM task WHERE uuid = ?");
  if (find.Bind(uuid).Step()) return find.Integer(0);
  Statement insert = database.Prepare(
      "INSERT INTO task(uuid, scenario, file, asked_grammar, settings, shows) VALUES(?, ?, ?, ?, "
      "?, ?)");
  insert.Bind(uuid).Bind(task.scenario).Bind(files.run.scenario_file).Bind(files.run.grammar);
  insert.Bind(nlohmann::json(files.run.settings).dump()).Bind(task.shows).Run();
  const std::int64_t row = database.LastRow();
  Compressor compressor;
  Statement has = database.Prepare("SELECT 1 FROM asset WHERE hash = ?");
  Statement add = database.Prepare("INSERT INTO asset VALUES(?, ?, ?)");
  Statement name = database.Prepare("INSERT INTO task_asset VALUES(?, ?, ?)");
  std::size_t bytes = 0;
  for (const auto& [path, content] : files.files) {
    CheckTaskBytes(bytes += content.size());
    const std::string hash = ContentHash(content);
    if (!has.Bind(hash).Step()) {
      add.Bind(hash).Bind(static_cast<std::int64_t>(content.size()));
      add.BindBytes(compressor.Pack(content)).Run();
    }
    has.Reset();
    name.Bind(row).Bind(path).Bind(hash).Run();
  }
  WriteEntities(database, row, uuid, task.entities);
  return row;
}

std::int64_t WriteEpisode(const Database& database, std::int64_t task, const NewEpisode& episode) {
  Statement insert = database.Prepare(
      "INSERT INTO episode(uuid, task, status, grammar, ticks_per_second, ticks, state_hash, "
      "outcome, engine, seed, program, program_hash, recorded_on, failure_entity, failure_reason, "
      "failure_advice) VALUES(?, ?, ?, ?, ?, 0, '', '', ?, ?, ?, ?, ?, '', '', '')");
  insert.Bind(episode.uuid.empty() ? NewUuid() : episode.uuid)
      .Bind(task)
      .Bind(kBeingRecorded)
      .Bind(episode.grammar);
  insert.Bind(episode.ticks_per_second).Bind(episode.engine).Bind(episode.seed);
  insert.Bind("prehend " PREHEND_VERSION)
      .Bind(episode.program_hash)
      .Bind(episode.recorded_on)
      .Run();
  return database.LastRow();
}

void WriteEnd(const Database& database, std::int64_t episode, const char* status,
              const RunResult& run, const grammar::EntityTable& entities) {
  WriteEvents(database, episode, entities, run.timeline);
  Statement note = database.Prepare("INSERT INTO note VALUES(?, ?, ?, ?, ?)");
  for (std::size_t i = 0; i < run.notes.size(); ++i) {
    note.Bind(episode).Bind(static_cast<std::int64_t>(i)).Bind(run.notes[i].tick);
    note.Bind(run.notes[i].hand.number()).Bind(run.notes[i].text).Run();
  }
  Statement end = database.Prepare(
      "UPDATE episode SET status = ?, ticks = ?, state_hash = ?, outcome = ?, failure_entity = ?, "
      "failure_reason = ?, failure_advice = ? WHERE id = ?");
  end.Bind(status).Bind(run.ticks).Bind(HashText(run.state_hash)).Bind(run.outcome);
  end.Bind(run.status.entity).Bind(run.status.reason).Bind(run.status.advice).Bind(episode).Run();
}

ChunkRows::ChunkRows(const Database& database, std::int64_t episode)
    : episode_(episode),
      insert_chunk_(database.Prepare("INSERT INTO chunk VALUES(?, ?, ?, ?)")),
      insert_part_(database.Prepare(
          "INSERT INTO part(episode, part, first_tick, data) VALUES(?, ?, ?, ?)")) {}

void ChunkRows::Write(const Chunk& chunk) {
  insert_chunk_.Bind(episode_).Bind(chunk.first_tick).Bind(chunk.last_tick);
  insert_chunk_.Bind(static_cast<std::int64_t>(chunk.frames)).Run();
  for (const ChunkPart& part : chunk.parts) {
    insert_part_.Bind(episode_).Bind(static_cast<std::int64_t>(part.part)).Bind(chunk.first_tick);
    insert_part_.BindBytes(part.bytes).Run();
  }
}

}  // namespace prehend::episode
