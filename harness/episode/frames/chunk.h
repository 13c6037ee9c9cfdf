// SPDX-License-Identifier: Apache-2.0
// A chunk: the frames of about a second as compressed parts, one per track that changed, so that
// one track or one frame can be read without the others. Tested by
// tests/harness/episode/frames/frames_test.cc
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "harness/episode/frames/frame_layout.h"
#include "physics/scene/hand_model.h"

namespace prehend::episode {

inline constexpr std::size_t kMostFramesOfChunk = 480;

struct ChunkPart {
  std::size_t part = 0;
  std::string bytes;
};

/// Frames of consecutive ticks (of a recording: of increasing ones).
struct Chunk {
  std::int64_t first_tick = 0, last_tick = 0;
  std::size_t frames = 0;
  std::vector<ChunkPart> parts;
};

/// Collects frames of consecutive ticks into chunks.
class ChunkWriter {
 public:
  explicit ChunkWriter(FrameLayout layout);

  void Add(const physics::Snapshot& snapshot);
  std::size_t frames() const { return frames_; }
  bool IsFull() const;
  /// The frames since the last chunk, of which there is at least one.
  Chunk Take();

 private:
  struct Track {
    std::vector<Word> last;  ///< empty before the first frame
    std::vector<Word> rows;  ///< a row per frame, if it has changed in this chunk
  };
  struct Links {
    physics::LinkPlaces places;
    std::vector<Word> rows;
    bool follow = true;  ///< from palm and joints, to the last bit, in all frames of this chunk
  };
  void AddTrack(std::size_t number, const physics::Snapshot& snapshot);
  void AddLinks(const physics::HandState& hand, Links& links);
  void AddResting(const physics::Snapshot& snapshot);

  FrameLayout layout_;
  TablePacker packer_;
  std::size_t frames_ = 0;
  std::size_t words_ = 0;
  std::int64_t last_tick_ = -1;
  std::vector<Track> tracks_;
  std::vector<Links> links_;
  std::vector<Word> row_;
  std::vector<physics::Pose> placed_;
  std::vector<ContactPoints> contacts_;  ///< frame by frame
  std::shared_ptr<const ContactPoints> resting_;
  /// What rests from which frame on, where that changes.
  std::vector<std::pair<std::size_t, std::shared_ptr<const ContactPoints>>> new_resting_;
};

}  // namespace prehend::episode
