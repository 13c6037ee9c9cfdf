// SPDX-License-Identifier: Apache-2.0
// Defines contact, the same for every engine. Two surfaces are in contact in a tick in which
// momentum passed between them, whatever their distance was before and after it: a bounce is over
// within one tick. A contact lasts until no impulse has passed for 8 ms, because the impulse of a
// resting contact flickers. What has pressed for longer than a blow also lasts until the
// surfaces are half a millimetre apart: the first micrometres of a slow lift take long, and how
// long is chance. Contacts between two resting bodies do not change and cost no time. Tested by
// tests/physics/world/contact_hold_test.cc, tests/physics/world/bounce_test.cc
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "physics/scene/snapshot.h"

namespace prehend::physics {

/// The order of contact points in snapshots: by (a, b, point).
bool ComesBefore(const ContactPoint& l, const ContactPoint& r);

class TouchingPairs {
 public:
  explicit TouchingPairs(int rate_hz = 480)
      : hold_ticks_(rate_hz / 120), blow_ticks_(rate_hz / 48) {}

  /// Call before the points of a tick are added. `rests`: by body of the scene, whether it is fixed
  /// or asleep after this tick.
  void BeginTick(const std::vector<char>& rests);
  /// Whether both rest and did so in the tick before: then there is no point to add.
  bool Rest(const ContactSide& a, const ContactSide& b) const { return Rests(a) && Rests(b); }
  /// Adds a contact point of the engine. A point without impulse begins no contact; it makes one
  /// last while it is near. The sides may be in any order.
  void Add(ContactPoint point);
  /// Call after the last point of the tick. `apart_m` measures how far the surfaces of two sides
  /// are from each other; it is asked where no point tells.
  void EndTick(const std::function<double(const ContactSide&, const ContactSide&)>& apart_m = {});
  /// Writes contacts, sorted by (a, b, point), and the resting ones. What `snapshot` says of hands
  /// is of this tick: their points without an impulse go along with them.
  void Describe(Snapshot& snapshot);

 private:
  struct Pair {
    std::vector<ContactPoint> points;  ///< of the last tick with an impulse
    Pose X_WH;                         ///< of the hand's link in the tick of the points
    int pressed_ticks = 0, quiet_ticks = 0;
    bool seen = false;  ///< in the present tick
    bool near = false;  ///< in the present tick, without an impulse

    void GoAlong(const Pose& X_WH_now);
  };
  using Pairs = std::map<std::pair<ContactSide, ContactSide>, Pair>;

  bool Rests(const ContactSide& side) const {
    return side.hand == kNone && side.body.IsBelow(rested_.size()) && At(rested_, side.body) != 0;
  }
  bool MovePairs(Pairs& from, Pairs& to, bool that_rest);
  void ShareResting();

  int hold_ticks_;            ///< a contact survives so many ticks (8 ms) without an impulse
  int blow_ticks_;            ///< what presses for more (20 ms) is no blow
  Pairs pairs_;               ///< pairs of which one side may move
  Pairs resting_;             ///< all other pairs
  std::vector<char> rests_;   ///< by body, after this tick
  std::vector<char> rested_;  ///< by body, after this tick and the one before
  std::shared_ptr<const std::vector<ContactPoint>> shared_;  ///< the points of `resting_`
};

}  // namespace prehend::physics
