// SPDX-License-Identifier: Apache-2.0
// The rows of an episode: its task with what that was made from, its begin, its chunks, its end.
// All throw DatabaseError. Tested by tests/harness/episode/episodes/episode_file_test.cc
#pragma once

#include <cstdint>
#include <string>

#include "grammar/base/frame.h"
#include "grammar/base/timeline.h"
#include "harness/episode/episodes/database.h"
#include "harness/episode/episodes/task_files.h"
#include "harness/episode/frames/chunk.h"
#include "harness/episode/run/run_scenario.h"

namespace prehend::episode {

/// An episode's status: `recording` until it is finished.
inline constexpr const char* kBeingRecorded = "recording";
inline constexpr const char* kCompleted = "completed";
inline constexpr const char* kFailed = "failed";
/// Of a recording that does not say where it ends.
inline constexpr const char* kUnfinished = "unfinished";
/// The engine of a recording: nothing was simulated.
inline constexpr const char* kNoEngine = "none";

struct NewTask {
  TaskFiles files;
  std::string scenario, shows;
  grammar::EntityTable entities;
};
/// Its row; it is written if the file does not have it.
std::int64_t WriteTask(const Database& database, const NewTask& task);

struct NewEpisode {
  std::string grammar;
  grammar::Tick ticks_per_second = 480;
  std::string engine;
  std::int64_t seed = 0;
  std::string program_hash, recorded_on;
};
/// Its row, with the status `recording`.
std::int64_t WriteEpisode(const Database& database, std::int64_t task, const NewEpisode& episode);

/// The status, the events and the notes of an episode that has come to its end. `run` has neither
/// frames nor, where nothing was simulated, a state hash.
void WriteEnd(const Database& database, std::int64_t episode, const char* status,
              const RunResult& run, const grammar::EntityTable& entities);

/// Writes chunk after chunk.
class ChunkRows {
 public:
  ChunkRows(const Database& database, std::int64_t episode);
  void Write(const Chunk& chunk);

 private:
  std::int64_t episode_;
  Statement insert_chunk_, insert_part_;
};

}  // namespace prehend::episode
