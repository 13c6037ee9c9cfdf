// SPDX-License-Identifier: Apache-2.0
// Chunks -> snapshots, frame after frame or at any place. Where its chunks come from is not its
// business. Tested by tests/harness/episode/frames/frames_test.cc
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/episode/frames/chunk.h"

namespace prehend::episode {

/// The bytes of a part of a chunk that is `back` chunks before the current one; nothing if there is
/// no such part. Valid until the next call.
using FetchPart = std::function<std::optional<std::string_view>(Word back, std::size_t part)>;

class FramePlayer {
 public:
  explicit FramePlayer(FrameLayout layout);
  FramePlayer(const FramePlayer&) = delete;
  FramePlayer& operator=(const FramePlayer&) = delete;

  /// Decodes a chunk. `follows`: it is the one after the chunk that was opened last, whose state is
  /// kept; otherwise what rests is fetched from where it stands. False: damaged.
  bool Open(const FetchPart& fetch, bool follows);
  const std::vector<std::int64_t>& ticks() const { return head_.ticks; }

  /// A frame of the chunk; nothing if it is damaged. Frames are shown in increasing order. Without
  /// `links`, the poses of the hands' links are not computed. Valid until the next call.
  const physics::Snapshot* Show(std::size_t frame, bool links = true);

  const FrameLayout& layout() const { return layout_; }

 private:
  bool OpenTrack(const FetchPart& fetch, std::size_t track, bool follows);
  bool OpenContacts(const FetchPart& fetch);
  bool OpenResting(const FetchPart& fetch, bool follows);
  /// The palm of a hand (place 0) or one of its links (place 1, ..) in the frames of a block of
  /// kLanes, computed once.
  const PlacedLinks& Placed(std::size_t hand, std::size_t place, std::size_t block);
  const physics::Pose& PlaceOf(std::size_t hand, std::size_t place, std::size_t frame) {
    return Placed(hand, place, frame / kLanes).X_WL[frame % kLanes];
  }
  physics::Pose PoseOf(std::size_t frame, const physics::ContactSide& side);

  FrameLayout layout_;
  PartReader parts_;
  ChunkHead head_;
  std::vector<std::optional<Columns>> tracks_;  ///< of those that change in this chunk
  std::vector<std::size_t> moving_;             ///< which those are
  std::optional<PartReader::Contacts> contacts_;
  std::vector<PartReader::RestingFrom> resting_;
  std::vector<std::optional<Columns>> links_;
  std::vector<LinkGuess> guesses_;
  struct HandPoses {  ///< block after block, in each place after place
    std::vector<char> known;
    std::vector<PlacedLinks> placed;
  };
  std::vector<HandPoses> hand_poses_;
  physics::Snapshot now_;
};

}  // namespace prehend::episode
