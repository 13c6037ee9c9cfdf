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
  /// Time for which a body is watched.
  static constexpr double kWatched_s = 0.05;

  /// A body that is neither fixed nor kinematic. Add all before the first step.
  void Add(btRigidBody& body) { bodies_.push_back({&body, false}); }

  /// Call after every step. When the time is over, Bullet is told that the bodies that never moved
  /// have rested for its two seconds; an island still falls asleep as a whole or not at all.
  ///
  /// To move is to be faster than the body's sleeping thresholds, scaled to the time: a constant
  /// acceleration from rest that passes a threshold within two seconds is seen here, too.
  void Watch(double dt_s);

 private:
  struct Watched {
    btRigidBody* body;
    bool moved;
  };
  std::vector<Watched> bodies_;  ///< empty when the time is over
  double time_s_ = 0;
};

}  // namespace prehend::physics
