// SPDX-License-Identifier: Apache-2.0
// Which bodies rest, and since when: they need not be described or sensed again. Tested by
// tests/physics/world/world_test.cc
#pragma once

#include <cstdint>
#include <vector>

#include "physics/scene/snapshot.h"

namespace prehend::physics {

class Stillness {
 public:
  explicit Stillness(std::size_t bodies) : rests_(bodies, 0), moved_tick_(bodies, 0) {}

  /// Call after every step. `rests(i)`: body i is fixed or asleep. A body that has just fallen
  /// asleep counts as moved in this tick, because it lost its speed.
  template <typename Rests>
  void Update(std::int64_t tick, const Rests& rests) {
    for (std::size_t i = 0; i < rests_.size(); ++i) {
      const char now = rests(i) ? 1 : 0;
      if ((now & rests_[i]) == 0) moved_tick_[i] = tick;
      rests_[i] = now;
    }
  }
  const std::vector<char>& rests() const { return rests_; }

  /// Writes the states that may differ from those in the snapshot; `state(i)` is the state of body
  /// i. The snapshot is new, or of the same world.
  template <typename State>
  void Describe(Snapshot& snapshot, const State& state) const {
    snapshot.bodies.resize(moved_tick_.size());
    for (std::size_t i = 0; i < moved_tick_.size(); ++i) {
      const bool known = !snapshot.moved_tick.empty() && moved_tick_[i] <= snapshot.tick;
      if (!known) snapshot.bodies[i] = state(i);
    }
    snapshot.moved_tick = moved_tick_;
  }

 private:
  std::vector<char> rests_;  // as bool, but fast to combine
  std::vector<std::int64_t> moved_tick_;
};

}  // namespace prehend::physics
