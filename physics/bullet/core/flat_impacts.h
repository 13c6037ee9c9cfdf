// SPDX-License-Identifier: Apache-2.0
// Contact points of fast impacts. Except for box against box, Bullet finds one point per tick and
// accumulates them: a can that falls flat on its base is stopped at one point of its rim and tips
// over. Only for physics/bullet. Tested by tests/physics/world/bounce_test.cc
#pragma once

#include <BulletCollision/CollisionDispatch/btConvexConvexAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>

namespace prehend::physics {

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
