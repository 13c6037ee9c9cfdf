// SPDX-License-Identifier: Apache-2.0
// See harness/episodes/record_episode.h. Tested by tests/harness/episodes/episode_file_test.cc
#include "harness/episodes/record_episode.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "harness/base/content_hash.h"
#include "harness/episodes/chunk.h"
#include "harness/episodes/schema.h"
#include "harness/episodes/task_files.h"
#include "harness/run/run_text.h"
#include "harness/sense/entity_table.h"

namespace prehend::harness::episodes {
namespace {

namespace fs = std::filesystem;

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

/// The row of the task, which is written if the file does not have it.
std::int64_t WriteTask(const Database& database, const RecordRequest& request,
                       const Scenario& scenario) {
  const TaskFiles task = PackTask(request.run, request.files, request.root);
  const std::string id = ScenarioId(scenario.skill, scenario.name);
  const std::string uuid = UuidOf(id + "\n" + task.Identity());
  Statement find = database.Prepare("SELECT id FROM task WHERE uuid = ?");
  if (find.Bind(uuid).Step()) return find.Integer(0);
  Statement insert = database.Prepare(
      "INSERT INTO task(uuid, scenario, file, asked_grammar, settings, shows)"
      " VALUES(?, ?, ?, ?, ?, ?)");
  insert.Bind(uuid).Bind(id).Bind(task.run.scenario_file).Bind(task.run.grammar);
  insert.Bind(nlohmann::json(task.run.settings).dump()).Bind(scenario.shows).Run();
  const std::int64_t row = database.LastRow();
  Compressor compressor(9);
  Statement add = database.Prepare("INSERT OR IGNORE INTO asset VALUES(?, ?, ?)");
  Statement name = database.Prepare("INSERT INTO task_asset VALUES(?, ?, ?)");
  for (const auto& [path, content] : task.files) {
    const std::string hash = ContentHash(content);
    const std::string packed(compressor.Pack(content));
    add.Bind(hash).Bind(static_cast<std::int64_t>(content.size())).BindBytes(packed).Run();
    name.Bind(row).Bind(path).Bind(hash).Run();
  }
  WriteEntities(database, row, uuid, MakeEntityTable(scenario));
  return row;
}

std::int64_t WriteEpisode(const Database& database, std::int64_t task, const Scenario& scenario,
                          const RecordRequest& request) {
  Statement insert = database.Prepare(
      "INSERT INTO episode(uuid, task, status, grammar, ticks_per_second, ticks, state_hash,"
      " outcome, engine, seed, program, program_hash, recorded_on, failure_entity,"
      " failure_reason, failure_advice) VALUES(?, ?, ?, ?, ?, 0, '', '', ?, ?, ?, ?, ?, '', '',"
      " '')");
  insert.Bind(NewUuid()).Bind(task).Bind(kRecording).Bind(scenario.grammar);
  insert.Bind(scenario.scene.world.rate_hz).Bind(EngineName(scenario.scene.world.engine));
  insert.Bind(static_cast<std::int64_t>(scenario.scene.world.seed));
  insert.Bind("prehend " PREHEND_VERSION)
      .Bind(request.program_hash)
      .Bind(request.recorded_on)
      .Run();
  return database.LastRow();
}

void WriteEvents(const Database& database, std::int64_t episode, const Scenario& scenario,
                 const grammar::Timeline& timeline) {
  const grammar::EntityTable table = MakeEntityTable(scenario);
  std::map<std::string, std::int64_t> numbers;
  for (std::size_t i = 0; i < table.entities.size(); ++i)
    numbers.try_emplace(table.entities[i].name, static_cast<std::int64_t>(i));
  const auto seconds = [&](grammar::Tick ticks) {
    return static_cast<double>(ticks) / static_cast<double>(timeline.ticks_per_second);
  };
  Statement insert = database.Prepare(
      "INSERT INTO event(episode, event, begin_tick, end_tick, decided_tick, open_end, begin_s,"
      " end_s, duration_s) VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?)");
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

struct EpisodeRecorder::State {
  Database database;
  const Scenario& scenario;
  ChunkWriter writer;
  Statement insert_chunk, insert_part;
  std::int64_t episode = 0;
  std::int64_t number = 0;
};

EpisodeRecorder::EpisodeRecorder(const RecordRequest& request, const Scenario& scenario)
    : file_(request.file) {
  try {
    Database database = OpenToWrite(request.file);
    Transaction transaction(database);
    const std::int64_t task = WriteTask(database, request, scenario);
    const std::int64_t episode = WriteEpisode(database, task, scenario, request);
    transaction.Commit();
    Statement chunk = database.Prepare(
        "INSERT INTO chunk(episode, number, first_tick, last_tick, frames) VALUES(?, ?, ?, ?, ?)");
    Statement part = database.Prepare("INSERT INTO part(id, data) VALUES(?, ?)");
    state_.reset(new State{.database = std::move(database),
                           .scenario = scenario,
                           .writer = ChunkWriter(LayoutOf(scenario.scene)),
                           .insert_chunk = std::move(chunk),
                           .insert_part = std::move(part),
                           .episode = episode});
  } catch (const DatabaseError& error) {
    problem_ = file_ + ": " + error.what();
  }
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
  try {
    Transaction transaction(state.database);
    state.insert_chunk.Bind(state.episode).Bind(state.number++).Bind(chunk.first_tick);
    state.insert_chunk.Bind(chunk.last_tick).Bind(static_cast<std::int64_t>(chunk.frames)).Run();
    const std::int64_t first = state.database.LastRow() * kPartsPerChunk;
    for (const ChunkPart& part : chunk.parts)
      state.insert_part.Bind(first + static_cast<std::int64_t>(part.part))
          .BindBytes(part.bytes)
          .Run();
    transaction.Commit();
  } catch (const DatabaseError& error) {
    problem_ = file_ + ": " + error.what();
  }
}

void EpisodeRecorder::Finish(const RunResult& run) {
  if (problem_.empty() && state_->writer.frames() > 0) WriteChunk();
  if (!problem_.empty()) return;
  State& state = *state_;
  const physics::RunStatus& status = run.status;
  const bool completed = status.kind == physics::RunStatus::Kind::kCompleted;
  try {
    Transaction transaction(state.database);
    WriteEvents(state.database, state.episode, state.scenario, run.timeline);
    Statement note = state.database.Prepare("INSERT INTO note VALUES(?, ?, ?, ?, ?)");
    for (std::size_t i = 0; i < run.notes.size(); ++i) {
      note.Bind(state.episode).Bind(static_cast<std::int64_t>(i)).Bind(run.notes[i].tick);
      note.Bind(run.notes[i].hand).Bind(run.notes[i].text).Run();
    }
    Statement end = state.database.Prepare(
        "UPDATE episode SET status = ?, ticks = ?, state_hash = ?, outcome = ?,"
        " failure_entity = ?, failure_reason = ?, failure_advice = ? WHERE id = ?");
    end.Bind(completed ? kCompleted : kFailed).Bind(run.ticks).Bind(HashText(run.state_hash));
    end.Bind(run.outcome).Bind(status.entity).Bind(status.reason).Bind(status.advice);
    end.Bind(state.episode).Run();
    transaction.Commit();
  } catch (const DatabaseError& error) {
    problem_ = file_ + ": " + error.what();
  }
}

std::string WhyNotRecordable(const std::string& file) {
  try {
    (void)OpenToWrite(file);
  } catch (const DatabaseError& error) {
    return file + ": " + error.what();
  }
  return "";
}

}  // namespace prehend::harness::episodes
