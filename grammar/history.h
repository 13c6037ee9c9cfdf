// SPDX-License-Identifier: Apache-2.0
// The recent past, by frame number: ticks of frames, looks of entities and hands. An entity's look is stored only when
// it changed, so sleeping objects take no space however long the past is kept.
// Tested by tests/grammar/history_test.cc
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "grammar/frame.h"
#include "grammar/ring.h"

namespace prehend::grammar {

/// Frames are numbered 0, 1, 2, ... as they arrive.
using FrameNumber = std::int64_t;
inline constexpr FrameNumber kNever = std::numeric_limits<FrameNumber>::max();

struct Moment {
  FrameNumber frame = 0;
  Tick tick = 0;
};

struct HandSample {
  FrameNumber frame = 0;
  HandLook look;  ///< its own span is empty, see `feelers`
  std::vector<Feeler> feelers;
};

class History {
 public:
  explicit History(const Cast& cast);

  void Push(const Frame& frame);
  /// Forgets ticks of frames before `ticks` and looks that only frames before `looks` need.
  void Forget(FrameNumber ticks, FrameNumber looks);

  /// No more frames will come.
  void Complete() { complete_ = true; }
  bool complete() const { return complete_; }

  /// Number of the newest frame; -1 before the first.
  FrameNumber now() const { return count_ - 1; }
  FrameNumber first() const { return count_ - static_cast<FrameNumber>(ticks_.size()); }
  Moment At(FrameNumber frame) const { return {frame, ticks_[static_cast<std::size_t>(frame - first())]}; }
  /// The first remembered frame at or after `tick`; now() + 1 if there is none.
  FrameNumber FirstNotBefore(Tick tick) const;
  /// The last remembered frame at or before `tick`; the first one if there is none.
  FrameNumber LastNotAfter(Tick tick) const;

  const EntityLook& Look(int entity, FrameNumber frame) const;
  /// Null if this entity is no hand.
  const HandSample* Hand(int entity, FrameNumber frame) const;
  double Seconds(Tick ticks) const { return static_cast<double>(ticks) / ticks_per_second_; }
  /// Whole ticks such that comparing differences of ticks gives the same as comparing seconds.
  Tick AtMostTicks(double seconds) const;
  Tick AtLeastTicks(double seconds) const;

 private:
  struct LookSample {
    FrameNumber frame = 0;
    EntityLook look;
  };

  double ticks_per_second_;
  FrameNumber count_ = 0;
  bool complete_ = false;
  Ring<Tick> ticks_;
  std::vector<Ring<LookSample>> looks_;        // by entity
  std::vector<Ring<HandSample>> hand_samples_;  // by hand, in order of first sight
  std::vector<int> hand_of_entity_;            // index into hand_samples_ or -1
};

}  // namespace prehend::grammar
