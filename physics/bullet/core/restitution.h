// SPDX-License-Identifier: Apache-2.0
// When and how fast things bounce in Bullet. Its solver lets a gap close within the tick at most,
// which is right for what does not bounce: who is pushed touches in this tick. But it adds the
// speed after a bounce to that, and so pushes as much as a tick's way too early, and takes gap / dt
// off the speed. Only for bullet_*.cc. Tested by tests/physics/world/bounce_test.cc
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <utility>
#include <vector>

namespace prehend::physics {

/// How fast the bodies come together at a point, m/s; negative: they part.
btScalar ApproachSpeed(const btPersistentManifold& manifold, const btManifoldPoint& point);

/// While it lives, contacts are as the solver has to see them: a point bounces in the tick in which
/// its gap closes, as if it were closed already, and not before. And a point that parts begins with
/// no impulse: Bullet begins with the last tick's, lets friction answer it, takes it back and
/// leaves the friction, which threw what had just bounced off to the side, turning.
class TimelyBounces {
 public:
  /// `slowest_m_per_s`: slower impacts do not bounce, and what is slower does not part.
  TimelyBounces(btPersistentManifold* const* manifolds, int count, btScalar dt_s,
                btScalar slowest_m_per_s);
  ~TimelyBounces();
  TimelyBounces(const TimelyBounces&) = delete;
  TimelyBounces& operator=(const TimelyBounces&) = delete;

 private:
  std::vector<std::pair<btManifoldPoint*, btScalar>> later_;  ///< and what their restitution is
};

}  // namespace prehend::physics
