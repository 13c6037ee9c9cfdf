// SPDX-License-Identifier: Apache-2.0
// Contact points of fast impacts. Except for box against box, Bullet finds one point per tick and
// accumulates them: a can that falls flat on its base is stopped at one point of its rim and tips
// over. Only for physics/bullet. Tested by tests/physics/world/bounce_test.cc
#pragma once

#include <BulletCollision/CollisionDispatch/btConvexConvexAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <utility>
#include <vector>

namespace prehend::physics {

// When and how fast bodies bounce in Bullet. Bullet closes a gap within one tick, which is right
// for a body that does not bounce, and adds the rebound velocity on top: a bouncing body rebounds
// up to one tick early and loses gap / dt of its speed. Only for physics/bullet. Tested by
// tests/physics/world/bounce_test.cc

/// Speed of approach of the two bodies at a point, m/s; negative: they separate.
btScalar ApproachSpeed(const btPersistentManifold& manifold, const btManifoldPoint& point);

/// Changes contact points for the solver during its lifetime. A point bounces in the tick in which
/// its gap closes, as if the gap were closed already, and not before. A separating point starts
/// with no impulse: Bullet warm-starts it with the last tick's impulse, computes friction from it
/// and removes the impulse but not the friction, which deflects and spins a body that has just
/// bounced.
class TimelyBounces {
 public:
  /// `slowest_m_per_s`: slower impacts do not bounce, and slower separation is ignored.
  TimelyBounces(btPersistentManifold* const* manifolds, int count, btScalar dt_s,
                btScalar slowest_m_per_s);
  ~TimelyBounces();
  TimelyBounces(const TimelyBounces&) = delete;
  TimelyBounces& operator=(const TimelyBounces&) = delete;

 private:
  std::vector<std::pair<btManifoldPoint*, btScalar>> later_;  ///< points and their own restitution
};

/// Slower contacts do not bounce.
inline constexpr btScalar kMinImpact_m_per_s = 0.2;

/// Bullet's collision detection, which finds all of a face in the tick of its impact. Slower
/// contacts and those of spheres, hands and persons are stock.
class ImpactConfiguration final : public btDefaultCollisionConfiguration {
 public:
  ImpactConfiguration();
  btCollisionAlgorithmCreateFunc* getCollisionAlgorithmCreateFunc(int type0, int type1) override;

 private:
  struct Impacts final : btConvexConvexAlgorithm::CreateFunc {
    using btConvexConvexAlgorithm::CreateFunc::CreateFunc;
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override;
  };
  Impacts impacts_;
};

}  // namespace prehend::physics
