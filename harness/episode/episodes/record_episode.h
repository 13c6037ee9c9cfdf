// SPDX-License-Identifier: Apache-2.0
// Writes an episode into an episode file while it is played. A chunk is one transaction: whenever
// the program is killed, the file has all chunks that were written, and an episode that did not
// come to its end says so. Several processes may add to one file. The rows of an episode: its
// task with what that was made from, its begin, its chunks, its end. All throw DatabaseError.
// Tested by tests/harness/episode/episodes/episode_file_test.cc
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grammar/base/frame.h"
#include "grammar/base/timeline.h"
#include "harness/base/base/atomic_file.h"
#include "harness/episode/episodes/database.h"
#include "harness/episode/frames/chunk.h"
#include "harness/episode/frames/frame_layout.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/episode/run/run_trials.h"
#include "harness/episode/run/task_files.h"
#include "harness/episode/sense/episode_file.h"

namespace prehend::episode {

struct RecordRequest {
  std::string file;
  std::string root;                ///< the project's; files below it are named relative to it
  RunRequest run;                  ///< what was asked for
  std::vector<std::string> files;  ///< all that LoadRun() tried to read
  std::string recorded_on;         ///< YYYY-MM-DD
  std::string program_hash;        ///< ProgramHash()
  std::string uuid = {};           ///< of the episode; "": a new one
};

class EpisodeRecorder {
 public:
  /// Errors, here and later, are told by problem(); a recorder with a problem does nothing more.
  EpisodeRecorder(const RecordRequest& request, const scenario::Scenario& scenario);
  ~EpisodeRecorder();
  EpisodeRecorder(EpisodeRecorder&&) noexcept;

  void Add(const physics::Snapshot& snapshot);
  /// The episode's end, its events and notes.
  void Finish(const RunResult& run);

  /// "", or why nothing can be recorded: "FILE: the disk is full".
  const std::string& problem() const { return problem_; }

 private:
  struct State;
  void WriteChunk();

  std::string file_;
  std::string problem_;
  std::unique_ptr<State> state_;
};

/// While it lives, others do not write into the file. A process that is forked has it too, and the
/// system takes it from processes that died.
using WriteLock = std::shared_ptr<void>;
enum class Writer {
  kAdds,      ///< new episodes, beside others that do
  kAlone,     ///< goes on with what was cut off, which could be another's
  kReplaces,  ///< the whole file, if there is one
};
/// Or why nothing can be recorded there, or nothing now. Creates the file with its tables.
tl::expected<WriteLock, std::string> LockToRecord(const std::string& file, Writer writer);

// A scenario is played, judged by its outcomes, and written where that is asked for. Tested by
// tests/program/recording_test.cc and tests/program/episodes_test.cc

/// Writes a run while it is played: into NAME.episodes, or what the grammar sees as JSON Lines into
/// any other file; "-" is standard output.
class RunRecorder {
 public:
  /// `request.file` is not empty. Errors, here and later, are told by problem().
  RunRecorder(const RecordRequest& request, const LoadedRun& loaded);

  void Add(ScenarioRun& playing);
  void Finish(const RunResult& run);

  /// "", or why it is not written.
  const std::string& problem() const { return episode_ ? episode_->problem() : problem_; }

 private:
  std::optional<EpisodeRecorder> episode_;
  std::optional<AtomicFile> file_;
  std::optional<EpisodeWriter> lines_;
  std::string problem_;
};

/// `recorder` may be null.
RunResult PlayScenario(const LoadedRun& loaded, const RunOptions& how, RunRecorder* recorder);

/// Plays one trial; `request` says what it is of, and where to.
TrialResult RecordTrial(int trial, const LoadedRun& loaded, const RecordRequest& request);

/// An episode's status: `recording` until it is finished.
inline constexpr const char* kBeingRecorded = "recording";
inline constexpr const char* kCompleted = "completed";
inline constexpr const char* kFailed = "failed";
/// Of a recording that does not say where it ends.
inline constexpr const char* kUnfinished = "unfinished";
/// The engine of a recording: nothing was simulated.
inline constexpr const char* kNoEngine = "none";

/// Of all files of a task. Throws DatabaseError if it is too much.
void CheckTaskBytes(std::size_t bytes);

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
  std::string uuid = {};  ///< "": a new one
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
