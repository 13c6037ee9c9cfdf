// SPDX-License-Identifier: Apache-2.0
// An episode as a file: who takes part, then one line per frame, each a JSON object (JSON Lines).
// What a grammar needs to segment it again, and nothing more: docs/recording-format.md. Written by
// `prehend run --record`, by trackers, by hand. Tested by tests/harness/sense/episode_file_test.cc
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "grammar/base/frame.h"
#include "harness/base/read_result.h"

namespace prehend::harness {

inline constexpr int kEpisodeVersion = 1;
inline constexpr std::size_t kMaxEpisodeFrames = 1'000'000;
inline constexpr std::size_t kMaxEpisodeBytes = std::size_t{1} << 30;
inline constexpr std::size_t kMaxEpisodeLineBytes = 1 << 20;

/// The first line.
struct EpisodeHeader {
  std::string episode;  ///< its name: of the scenario it was recorded from
  std::string grammar;  ///< that watches unless another one is asked for
  grammar::EntityTable entity_table;
};

/// A frame that owns what it shows.
struct EpisodeFrame {
  grammar::Tick tick = 0;
  std::vector<grammar::EntitySample> entities;
  std::vector<grammar::HandSample> hands;  ///< their own spans are empty, see `collision_spheres`
  std::vector<std::vector<grammar::CollisionSphere>> collision_spheres;  ///< per hand
  std::vector<grammar::Touch> touches;

  /// Lives as long as this and until it changes.
  grammar::Frame View();
};

struct Episode {
  EpisodeHeader header;
  std::vector<EpisodeFrame> frames;
  grammar::Tick end_tick = 0;  ///< the first that no longer belongs to it
};

/// Complains with file, line and column; limits as above.
ReadResult<Episode> ReadEpisode(const std::string& path);

/// Writes line by line, as the frames come.
class EpisodeWriter {
 public:
  EpisodeWriter(std::ostream& out, const EpisodeHeader& header);
  void Write(const grammar::Frame& frame);
  void Finish(grammar::Tick end_tick);

 private:
  std::ostream& out_;
  grammar::EntityTable entity_table_;
  std::vector<std::string> shown_;  ///< per entity: how it looked when last written
};

}  // namespace prehend::harness
