// SPDX-License-Identifier: Apache-2.0
// Frames of a recording (what a grammar sees, of a tracker or of another program) as tables.
// Tested by tests/harness/episode/frames/recorded_frames_test.cc
#pragma once

#include <span>
#include <vector>

#include "harness/episode/frames/columns.h"
#include "harness/episode/sense/episode_file.h"

namespace prehend::episode {

/// How many of these frames a chunk has, at least one: fewer if much is in them.
std::size_t FramesOfChunk(std::span<const EpisodeFrame> frames);

/// `placed`: as of the episode.
std::vector<Columns> TablesOfFrames(std::span<const EpisodeFrame> frames,
                                    const std::vector<bool>& placed);

struct RecordedFrames {
  std::vector<EpisodeFrame> frames;
  std::vector<bool> placed;
};
/// Throws Damage if they are none, or name what the entities do not have; any tables are safe.
RecordedFrames FramesOfTables(const std::vector<Columns>& tables,
                              const grammar::EntityTable& entities);

}  // namespace prehend::episode
