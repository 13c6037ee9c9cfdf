// SPDX-License-Identifier: Apache-2.0
// How much of the past the engine keeps: what the instances that are awake have not looked at yet,
// and as far before that as a rule can look back. Tested by tests/grammar/monitor_test.cc
#pragma once

#include <algorithm>
#include <vector>

#include "grammar/engine/history.h"
#include "grammar/engine/rule_ticks.h"

namespace prehend::grammar {

class RememberedPast {
 public:
  /// A rule looks back so far: to an earlier frame, at the edge of a condition from there to the
  /// frame before, and from that one over windows, one in another.
  void LookBack(const Rule& rule, const History& history) {
    longest_look_back_ = std::max(longest_look_back_, history.AtLeastTicks(LooksBack_s(rule)));
    longest_window_ = std::max(longest_window_, history.AtLeastTicks(rule.looks_around_s));
    const auto windows = static_cast<std::size_t>(rule.windows);
    if (ticks_.windows.size() < windows) ticks_.windows.resize(windows, 0);
    if (looks_.windows.size() < windows) looks_.windows.resize(windows, 0);
  }

  /// At a new frame nothing older is needed, until an instance needs it.
  void BeginFrame(FrameNumber now) { ticks_.oldest = looks_.oldest = now; }
  void Need(FrameNumber frame) { ticks_.oldest = std::min(ticks_.oldest, frame); }
  /// Likewise, with the poses, hands and touches of the frame.
  void NeedLooks(FrameNumber frame) { looks_.oldest = std::min(looks_.oldest, frame); }
  /// In this and all frames to come, as long as NeedHeld() says so.
  void Hold(FrameNumber frame, bool looks, InstanceId instance) {
    ticks_.held.push_back({frame, instance});
    std::ranges::push_heap(ticks_.held, Later);
    if (!looks) return;
    looks_.held.push_back({frame, instance});
    std::ranges::push_heap(looks_.held, Later);
  }
  /// still_holds(frame, instance): whether this is still needed.
  template <typename StillHolds>
  void NeedHeld(const StillHolds& still_holds) {
    for (Past* past : {&ticks_, &looks_}) {
      std::vector<Held>& held = past->held;
      while (!held.empty() && !still_holds(held.front().frame, held.front().instance)) {
        std::ranges::pop_heap(held, Later);
        held.pop_back();
      }
      if (!held.empty()) past->oldest = std::min(past->oldest, held.front().frame);
    }
  }

  /// Drops what is not needed.
  void Forget(History& history) {
    const FrameNumber ticks = FirstToKeep(history, ticks_);
    const bool same = looks_.oldest == ticks_.oldest;
    history.Forget(ticks, same ? ticks : FirstToKeep(history, looks_));
  }

 private:
  struct Held {
    FrameNumber frame = 0;
    InstanceId instance;
  };
  static bool Later(const Held& a, const Held& b) { return a.frame > b.frame; }

  /// What is kept, step by step: none goes back again.
  struct Past {
    FrameNumber oldest = 0;            // that an instance needs
    FrameNumber first = 0;             // that it may ask for, and two more
    std::vector<FrameNumber> windows;  // where a window around that begins, and so on
    std::vector<Held> held;            // a heap, the oldest first
  };

  // Two frames more are kept, for differences between frames: edges and speeds. Time between frames
  // may be longer than a window, so each window begins at a frame, not at a tick.
  FrameNumber FirstToKeep(const History& history, Past& past) const {
    const FrameNumber known = history.first();
    const Tick earliest = history.At(std::max(past.oldest, known)).tick - longest_look_back_;
    past.first = std::max(past.first, known);
    while (past.first + 2 <= history.now() && history.At(past.first + 2).tick < earliest)
      ++past.first;
    FrameNumber from = past.first;
    for (FrameNumber& window : past.windows) {
      const Tick begin = history.At(from).tick - longest_window_;
      window = std::max(window, known);
      while (window + 1 <= from && history.At(window + 1).tick <= begin) ++window;
      from = window;
    }
    return from;
  }

  Tick longest_look_back_ = 0;
  Tick longest_window_ = 0;
  Past ticks_;
  Past looks_;
};

}  // namespace prehend::grammar
