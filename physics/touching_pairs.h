// SPDX-License-Identifier: Apache-2.0
// What counts as touching, the same for every engine. Two surfaces touch when they are nearer than
// 0.5 mm and push each other; once they do, they touch until neither held for a few ticks, because
// a resting contact's impulse flickers. Tested by tests/physics/world_test.cc
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "physics/snapshot.h"

namespace prehend::physics {

class TouchingPairs {
 public:
  /// Before the engine's points of a tick are added.
  void BeginTick();
  /// A point that the engine knows; one that does not touch is left out. The sides may come in any
  /// order.
  void Add(ContactPoint point);
  /// After the last point of the tick.
  void EndTick();
  /// Sorted by (a, b, point).
  void Describe(std::vector<ContactPoint>& contacts) const;

 private:
  struct Pair {
    std::vector<ContactPoint> points;  ///< of the last tick at which they touched
    int quiet_ticks = 0;
    bool seen = false;  ///< in the present tick
  };

  std::map<std::pair<ContactSide, ContactSide>, Pair> pairs_;
};

}  // namespace prehend::physics
