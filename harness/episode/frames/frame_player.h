// SPDX-License-Identifier: Apache-2.0
// Chunks -> snapshots, frame after frame or at any place. Where its chunks come from is not its
// business. Tested by tests/harness/episode/frames/frames_test.cc
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "harness/episode/frames/frame_layout.h"
#include "physics/scene/hand_model.h"

namespace prehend::episode {

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
