// SPDX-License-Identifier: Apache-2.0
// Contact facts, read from Bullet's manifolds after a step (under 1 % of a tick). Two surfaces
// touch when they are nearer than 0.5 mm and push each other; once they do, they touch until
// neither held for a few ticks, because a resting contact's impulse flickers. Only for bullet_*.cc.
// Tested by tests/physics/world_test.cc
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include <map>
#include <utility>
#include <vector>

#include "physics/snapshot.h"

namespace prehend::physics {

/// Who a collision object is: one side for all of it, or one for each shape of its compound. The
/// world gives every object its index here as Bullet's user index.
using ContactSides = std::vector<std::vector<ContactSide>>;

class BulletContacts {
 public:
  explicit BulletContacts(ContactSides sides) : sides_(std::move(sides)) {}

  /// After every step.
  void Read(const btDispatcher& dispatcher);
  /// Sorted by (a, b, point).
  void Describe(std::vector<ContactPoint>& contacts) const;

 private:
  struct Pair {
    std::vector<ContactPoint> points;  ///< of the last tick at which they touched
    int quiet_ticks = 0;
    bool seen = false;  ///< in the present tick
  };

  ContactSides sides_;
  std::map<std::pair<ContactSide, ContactSide>, Pair> pairs_;
};

}  // namespace prehend::physics
