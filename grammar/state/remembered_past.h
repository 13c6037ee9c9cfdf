// SPDX-License-Identifier: Apache-2.0
// How much of the past the engine keeps: what the instances that are awake have not looked at yet,
// and as far before that as a rule can look back. Tested by tests/grammar/monitor_test.cc
#pragma once

#include <algorithm>
#include <vector>

#include "grammar/state/history.h"
#include "grammar/state/instances.h"

namespace prehend::grammar {

class RememberedPast {
 public:
  explicit RememberedPast(std::size_t entities) : is_held_(entities) {}

  /// The oldest frame that an instance which waits, or has waited, may ask for.
  struct Held {
    FrameNumber frame = 0;
    InstanceId instance;
  };

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
  /// Likewise, with the poses, hands and touches of the frame. False if only those that somebody
  /// holds are there still.
  bool NeedLooks(FrameNumber frame) {
    if (frame < passed_looks_) return false;
    looks_.oldest = std::min(looks_.oldest, frame);
    return true;
  }
  /// Like Need(), in this and all frames to come, as long as the instance holds it.
  template <typename IsHeld>
  void Hold(FrameNumber frame, InstanceId instance, const IsHeld& is_held) {
    if (held_.size() == held_.capacity()) {
      MakeRoom(held_, is_held);
      std::ranges::make_heap(held_, Later);
    }
    held_.push_back({frame, instance});
    std::ranges::push_heap(held_, Later);
  }
  /// Likewise, with the looks of one entity.
  template <typename IsHeld>
  void HoldLooks(int entity, FrameNumber frame, InstanceId instance, const History& history,
                 const IsHeld& is_held) {
    if (held_looks_.empty()) held_looks_.resize(is_held_.size());
    is_held_[static_cast<std::size_t>(entity)] = 1;
    std::vector<HeldLooks>& held = held_looks_[static_cast<std::size_t>(entity)];
    if (held.size() == held.capacity()) MakeRoom(held, is_held);
    held.push_back({{frame, instance}, FirstToKeep(history, frame)});
  }
  /// is_held(held): whether the instance still holds that frame; from(held): from where on it does
  /// so from now on.
  template <typename IsHeld, typename From>
  void NeedHeld(const IsHeld& is_held, const From& from) {
    while (!held_.empty()) {
      const Held oldest = held_.front();
      const bool is_needed = is_held(oldest);
      const FrameNumber first = is_needed ? from(oldest) : oldest.frame;
      if (is_needed && first == oldest.frame) return Need(first);
      std::ranges::pop_heap(held_, Later);
      held_.pop_back();
      if (!is_needed) continue;
      held_.push_back({first, oldest.instance});
      std::ranges::push_heap(held_, Later);
    }
  }
  /// The first frame whose look of this entity somebody may ask for.
  template <typename IsHeld>
  FrameNumber FirstLook(int entity, const History& history, const IsHeld& is_held) {
    FrameNumber first = history.first_look();
    if (is_held_[static_cast<std::size_t>(entity)] == 0) return first;
    std::vector<HeldLooks>& held = held_looks_[static_cast<std::size_t>(entity)];
    DropReleased(held, is_held);
    is_held_[static_cast<std::size_t>(entity)] = held.empty() ? 0 : 1;
    for (const HeldLooks& looks : held) first = std::min(first, looks.first);
    return first;
  }

  /// Drops what is not needed.
  void Forget(History& history) {
    passed_looks_ = std::max(passed_looks_, looks_.oldest);
    const FrameNumber ticks = FirstToKeep(history, ticks_);
    const bool same = looks_.oldest == ticks_.oldest;
    history.Forget(ticks, same ? ticks : FirstToKeep(history, looks_));
  }

 private:
  struct HeldLooks : Held {
    FrameNumber first = 0;  // that may be asked for from there
  };
  template <typename AnyHeld, typename IsHeld>
  static void DropReleased(std::vector<AnyHeld>& held, const IsHeld& is_held) {
    std::erase_if(held, [&](const AnyHeld& one) { return !is_held(one); });
  }
  // What others hold longer hides what was released long ago. More than half of the room is free
  // afterwards, so that this is not done again soon.
  template <typename AnyHeld, typename IsHeld>
  static void MakeRoom(std::vector<AnyHeld>& held, const IsHeld& is_held) {
    DropReleased(held, is_held);
    held.reserve(std::max(held.capacity(), 2 * held.size() + 1));
  }
  static bool Later(const Held& a, const Held& b) { return a.frame > b.frame; }

  /// What is kept, step by step: none goes back again.
  struct Past {
    FrameNumber oldest = 0;            // that an instance needs
    FrameNumber first = 0;             // that it may ask for, and two more
    std::vector<FrameNumber> windows;  // where a window around that begins, and so on
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

  // Likewise, what one that waits at `frame` may ask for, which may be the one to come.
  FrameNumber FirstToKeep(const History& history, FrameNumber frame) const {
    const Tick earliest = history.At(std::min(frame, history.now())).tick - longest_look_back_;
    FrameNumber from = history.FirstNotBefore(earliest) - 2;
    for (std::size_t i = 0; i < looks_.windows.size(); ++i) {
      from = std::max(from, history.first());
      from = history.LastNotAfter(history.At(from).tick - longest_window_);
    }
    return from;
  }

  Tick longest_look_back_ = 0;
  Tick longest_window_ = 0;
  Past ticks_;
  Past looks_;
  FrameNumber passed_looks_ = 0;                    // what only earlier frames need is gone
  std::vector<Held> held_;                          // a heap, the oldest first
  std::vector<std::vector<HeldLooks>> held_looks_;  // by entity, once there are any
  std::vector<char> is_held_;                       // by entity: such an instance may be there
};

}  // namespace prehend::grammar
