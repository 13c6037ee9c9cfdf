// SPDX-License-Identifier: Apache-2.0
// Frames of a recording (what a grammar sees, of a tracker or of another program) as few bytes,
// without loss. Tested by tests/harness/episode/frames/recorded_frames_test.cc
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/episode/sense/episode_file.h"

namespace prehend::episode {

/// How many of these frames a chunk has, at least one: fewer if much is in them.
std::size_t FramesOfChunk(std::span<const EpisodeFrame> frames);

/// `placed`: as of the episode. `ticks_per_second` is that of its entities' table.
std::string EncodeRecordedFrames(std::span<const EpisodeFrame> frames,
                                 const std::vector<bool>& placed, grammar::Tick ticks_per_second);

struct RecordedFrames {
  std::vector<EpisodeFrame> frames;
  std::vector<bool> placed;
};
/// Nothing if the bytes are damaged, or name what the table does not have; any bytes are safe.
std::optional<RecordedFrames> DecodeRecordedFrames(std::string_view bytes,
                                                   const grammar::EntityTable& table);

}  // namespace prehend::episode
