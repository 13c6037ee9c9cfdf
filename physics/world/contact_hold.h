// SPDX-License-Identifier: Apache-2.0
// What counts as touching, the same for every engine. Two surfaces touch in a tick in which
// momentum passed between them, wherever they were before and after it: a bounce is over within
// one. Once they touch, they do until they have not pushed for a few ticks, because a resting
// contact's impulse flickers. Between two that rest nothing changes, and it costs no time. Tested
// by tests/physics/world/world_test.cc, tests/physics/world/bounce_test.cc
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "physics/scene/snapshot.h"

namespace prehend::physics {

class TouchingPairs {
 public:
  /// Before the engine's points of a tick are added. `rests`: by body of the scene, whether it is
  /// fixed or asleep after this tick.
  void BeginTick(const std::vector<char>& rests);
  /// Both rest and did so before: there is nothing to add between them.
  bool Rest(const ContactSide& a, const ContactSide& b) const { return Rests(a) && Rests(b); }
  /// A point that the engine knows; one that does not push is left out. The sides may come in any
  /// order.
  void Add(ContactPoint point);
  /// After the last point of the tick.
  void EndTick();
  /// Writes contacts, sorted by (a, b, point), and the resting ones.
  void Describe(Snapshot& snapshot) const;

 private:
  struct Pair {
    std::vector<ContactPoint> points;  ///< of the last tick at which they touched
    int quiet_ticks = 0;
    bool seen = false;  ///< in the present tick
  };
  using Pairs = std::map<std::pair<ContactSide, ContactSide>, Pair>;

  bool Rests(const ContactSide& side) const {
    return side.hand < 0 && static_cast<std::size_t>(side.body) < rested_.size() &&
           rested_[static_cast<std::size_t>(side.body)] != 0;
  }
  bool MovePairs(Pairs& from, Pairs& to, bool that_rest);
  void ShareResting();

  Pairs pairs_;                                              ///< of which one may move
  Pairs resting_;                                            ///< the others
  std::vector<char> rests_;                                  ///< by body, after this tick
  std::vector<char> rested_;                                 ///< after the tick before, too
  std::shared_ptr<const std::vector<ContactPoint>> shared_;  ///< the points of `resting_`
};

}  // namespace prehend::physics
