// SPDX-License-Identifier: Apache-2.0
// Bodies that stand still when the scene begins fall asleep at once. Bullet waits for two seconds:
// 5,000 boxes cost 36 s before anything happened. Only for physics/bullet. Tested by
// tests/physics/world/first_rest_test.cc
#pragma once

#include <btBulletDynamicsCommon.h>

#include <vector>

namespace prehend::physics {

/// Watches the first ticks of a crowd. In scenes of few bodies it does nothing: they wait for two
/// seconds like stock Bullet, which costs them little.
class FirstRest {
 public:
  /// So many bodies are a crowd.
  static constexpr std::size_t kCrowd = 100;
  /// Ticks that begin without watching: where its height rounds to a gap, a body falls for a tick,
  /// and then its contacts push it out of what it fell into, less by a fifth from tick to tick.
  static constexpr int kSettling_ticks = 19;
  /// Ticks for which a body is watched then. One that still moves, but is where it began, is
  /// watched again, so many times in all: a tower settles later than a single body.
  static constexpr int kWatched_ticks = 5, kMaxWatches = 4;
  static constexpr double kWhereItBegan_m = 1e-4;

  /// A body that is neither fixed nor kinematic. Add all before the first step.
  void Add(btRigidBody& body) {
    bodies_.push_back({&body, body.getWorldTransform().getOrigin(), false});
  }

  /// Call after every step. After each watch, Bullet is told that the bodies that did not move in
  /// it have rested for its two seconds; an island still falls asleep as a whole or not at all.
  ///
  /// To move is to be faster than the body's sleeping thresholds, scaled to the time: a constant
  /// acceleration from rest that passes a threshold within two seconds is seen here, too.
  void Watch(double dt_s);

 private:
  struct Watched {
    btRigidBody* body;
    btVector3 p_W_m;  ///< at the begin
    bool moved;       ///< in the present watch
  };
  std::vector<Watched> bodies_;  ///< those that are still watched
  int ticks_ = 0;
};

}  // namespace prehend::physics
