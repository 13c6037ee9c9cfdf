// SPDX-License-Identifier: Apache-2.0
// Frames in memory, each as its changes. They can be played to monitors any number of times.
// Tested by tests/bench/workload_test.cc
#pragma once

#include <cstddef>
#include <vector>

#include "grammar/base/frame.h"

namespace prehend::bench {

class ChangeLog {
 public:
  grammar::EntityTable entity_table;

  std::size_t size() const { return frames_.size(); }
  grammar::Tick end_tick() const { return frames_.empty() ? 0 : frames_.back().tick + 1; }

  /// Begins a frame; what is added from now on are its changes.
  void Begin(grammar::Tick tick) {
    frames_.push_back(
        {tick, entities_.size(), hands_.size(), touches_.size(), contact_ends_.size()});
  }
  void Add(const grammar::EntityChange& change) { entities_.push_back(change); }
  /// Its collision spheres are dropped: they would not outlive the call.
  void Add(grammar::HandSample hand) {
    hand.collision_spheres = {};
    hands_.push_back(hand);
  }
  void Add(const grammar::Touch& touch) { touches_.push_back(touch); }
  void Add(const grammar::ContactEnd& contact_end) { contact_ends_.push_back(contact_end); }

  /// Valid until something is added.
  grammar::FrameChanges operator[](std::size_t i) const {
    const Start& here = frames_[i];
    const bool is_last = i + 1 == frames_.size();
    const Start next =
        is_last ? Start{0, entities_.size(), hands_.size(), touches_.size(), contact_ends_.size()}
                : frames_[i + 1];
    return {here.tick,
            {entities_.data() + here.entity, next.entity - here.entity},
            {hands_.data() + here.hand, next.hand - here.hand},
            {touches_.data() + here.touch, next.touch - here.touch},
            {contact_ends_.data() + here.contact_end, next.contact_end - here.contact_end}};
  }

 private:
  struct Start {
    grammar::Tick tick = 0;
    std::size_t entity = 0, hand = 0, touch = 0, contact_end = 0;
  };
  std::vector<Start> frames_;
  std::vector<grammar::EntityChange> entities_;
  std::vector<grammar::HandSample> hands_;
  std::vector<grammar::Touch> touches_;
  std::vector<grammar::ContactEnd> contact_ends_;
};

}  // namespace prehend::bench
