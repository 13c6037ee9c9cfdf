// SPDX-License-Identifier: Apache-2.0
// Reads an episode file: what episodes it has, what they were made from, their events, and any
// frame of them. Tested by tests/harness/episode/episodes/episode_file_test.cc
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/base/timeline.h"
#include "harness/base/base/result.h"
#include "harness/episode/episodes/database.h"
#include "harness/episode/frames/chunk.h"
#include "harness/episode/run/task_files.h"
#include "physics/simulation.h"

namespace prehend::episode {

struct EpisodeRow {
  std::int64_t id = 0;
  std::string uuid;
  std::string scenario;   ///< skill/name
  std::string status;     ///< recording (not finished), completed, failed, unfinished
  bool simulated = true;  ///< otherwise a recording: frames as a grammar sees them
  std::string grammar;
  grammar::Tick ticks_per_second = 480;
  grammar::Tick ticks = 0;  ///< of one that is not finished: those that can be read
  std::string state_hash;   ///< "0x.."; empty if it is not finished
  std::string outcome;
  std::string recorded_on;
  physics::RunStatus end;  ///< how the run ended; one that is not finished has failed
};

/// An entity as a file keeps it.
struct KeptEntity {
  std::string name;
  std::vector<std::string> classes;   ///< the most specific first
  int part_of = -1;                   ///< index of an entity of the same episode, or -1
  std::string uuid;                   ///< the same in all episodes of a task
  double mass_kg = 0;                 ///< 0: it has none
  std::array<double, 3> size_m = {};  ///< of its bounding box
};

/// What was run, as a file keeps it.
struct KeptTask {
  struct Asset {
    std::string path, hash;  ///< XXH3 of its content
  };
  std::string uuid, shows;
  std::vector<Asset> assets;
};

/// A file that is open for reading. Errors name the file and, of frames, the episode.
class EpisodeFile {
 public:
  static Result<EpisodeFile> Open(const std::string& path);

  const std::string& path() const { return path_; }
  /// In the order in which they were begun.
  const std::vector<EpisodeRow>& episodes() const { return episodes_; }

  Result<TaskFiles> TaskOf(const EpisodeRow& episode) const;
  /// The same without the contents of its files.
  Result<KeptTask> DescribeTaskOf(const EpisodeRow& episode) const;
  /// What was recognised when it was recorded.
  Result<grammar::Timeline> TimelineOf(const EpisodeRow& episode) const;
  /// In the order of their numbers.
  Result<std::vector<KeptEntity>> EntitiesOf(const EpisodeRow& episode) const;
  Result<std::vector<physics::ScriptNote>> NotesOf(const EpisodeRow& episode) const;

  /// An error unless there is a frame of each tick of a run, at the rate of its world.
  Result<void> CheckFrames(const EpisodeRow& episode, int rate_hz) const;

  struct ChunkOfPart {
    std::int64_t first_tick = 0;
    std::size_t frames = 0;
    std::optional<std::string_view> part;  ///< nothing: the chunk does not have it
  };
  /// Calls `look`, which may throw Damage, with this part of each chunk, in their order.
  Result<void> EachPart(const EpisodeRow& episode, std::size_t part,
                        const std::function<void(const ChunkOfPart&)>& look) const;

 private:
  friend class EpisodeFrames;
  EpisodeFile(std::string path, Database database)
      : path_(std::move(path)), database_(std::move(database)) {}

  std::string path_;
  Database database_;
  std::vector<EpisodeRow> episodes_;
};

/// The frames of one episode. The file outlives it.
class EpisodeFrames {
 public:
  EpisodeFrames(const EpisodeFile& file, const EpisodeRow& episode, FrameLayout layout)
      : file_(file), episode_(episode), player_(std::move(layout)) {}

  /// Calls `look` with each frame that is `wanted`, in their order.
  Result<void> Play(const std::function<void(const physics::Snapshot&)>& look,
                    const std::function<bool(std::int64_t tick)>& wanted = {}, bool links = true);

  /// The last frame up to this tick; it is an error if there is none. Which bodies may have moved
  /// is not known of it. Takes time with the logarithm of the number of frames.
  Result<physics::Snapshot> At(std::int64_t tick);

  struct Moment {
    std::int64_t tick = 0;
    physics::BodyState body;
  };
  /// All frames of one body.
  Result<std::vector<Moment>> TrackOf(std::size_t body);

 private:
  void OpenChunk(Statement& parts, std::int64_t first_tick, std::int64_t frames, bool follows);

  const EpisodeFile& file_;
  EpisodeRow episode_;
  FramePlayer player_;
};

}  // namespace prehend::episode
