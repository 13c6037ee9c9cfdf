// SPDX-License-Identifier: Apache-2.0
// A chunk: the frames of about a second as compressed parts, one per track that changed, so that
// one track or one frame can be read without the others. Chunks -> snapshots, frame after frame or
// at any place. Where its chunks come from is not its business. Tested by
// tests/harness/episode/frames/frames_test.cc
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
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

/// The bytes of a part: `here` of the chunk that is opened, else of the last one up to it that has
/// the part. Nothing if there is none. Valid until the next call.
using FetchPart = std::function<std::optional<std::string_view>(std::size_t part, bool here)>;

/// All throw Damage.
class FramePlayer {
 public:
  explicit FramePlayer(FrameLayout layout);

  /// Decodes a chunk of so many frames. `follows`: it is the one after the chunk that was opened
  /// last, whose state is kept; otherwise what rests is fetched from where it stands.
  void Open(const FetchPart& fetch, std::int64_t first_tick, std::size_t frames, bool follows);

  /// A frame of the chunk. Frames are shown in increasing order. Without `links`, the poses of the
  /// hands' links are not computed. Valid until the next call.
  const physics::Snapshot& Show(std::size_t frame, bool links = true);

  /// A track from its part: one row at least.
  Columns Track(std::size_t track, std::string_view part);

  const FrameLayout& layout() const { return layout_; }

 private:
  void OpenTrack(const FetchPart& fetch, std::size_t track, bool follows);
  void OpenResting(const FetchPart& fetch, bool follows);
  Columns Table(std::string_view part, std::size_t width);

  FrameLayout layout_;
  TablePacker packer_;
  std::vector<std::size_t> widths_;  ///< of tracks
  std::vector<physics::LinkPlaces> places_;

  std::int64_t first_tick_ = 0;
  std::size_t frames_ = 0;
  std::vector<std::optional<Columns>> tracks_;  ///< of those that change in this chunk
  std::vector<std::optional<Columns>> links_;   ///< where they do not follow from the joints
  std::vector<ContactPoints> contacts_;         ///< empty: there are none in this chunk
  struct RestingFrom {
    std::size_t frame = 0;
    std::shared_ptr<const ContactPoints> points;
  };
  std::vector<RestingFrom> resting_;
  physics::Snapshot now_;
};

}  // namespace prehend::episode
