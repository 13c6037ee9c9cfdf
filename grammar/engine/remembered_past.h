// SPDX-License-Identifier: Apache-2.0
// How much of the past the engine keeps: what the instances that are awake have not looked at yet,
// and as far before that as a rule can look back. Tested by tests/grammar/monitor_test.cc
#pragma once

#include <algorithm>

#include "grammar/engine/history.h"

namespace prehend::grammar {

class RememberedPast {
 public:
  /// A rule looks back so far.
  void LookBack(Tick ticks) { longest_look_back_ = std::max(longest_look_back_, ticks); }

  /// At a new frame nothing older is needed, until an instance needs it.
  void BeginFrame(FrameNumber now) { oldest_ = oldest_look_ = now; }
  void Need(FrameNumber frame) { oldest_ = std::min(oldest_, frame); }
  /// Likewise, with the poses, hands and touches of the frame.
  void NeedLooks(FrameNumber frame) { oldest_look_ = std::min(oldest_look_, frame); }

  /// Drops what is not needed; keeps two frames more, for differences between frames.
  void Forget(History& history) {
    first_ = FirstToKeep(history, oldest_, first_);
    first_look_ = FirstToKeep(history, oldest_look_, first_look_);
    history.Forget(first_, first_look_);
  }

 private:
  FrameNumber FirstToKeep(const History& history, FrameNumber needed, FrameNumber before) const {
    const Tick earliest = history.At(std::max(needed, history.first())).tick - longest_look_back_;
    FrameNumber frame = std::max(before, history.first());
    while (frame + 2 <= history.now() && history.At(frame + 2).tick < earliest) ++frame;
    return frame;
  }

  Tick longest_look_back_ = 0;
  FrameNumber oldest_ = 0;  // that an instance needs
  FrameNumber oldest_look_ = 0;
  FrameNumber first_ = 0;  // that is kept
  FrameNumber first_look_ = 0;
};

}  // namespace prehend::grammar
