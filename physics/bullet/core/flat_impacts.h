// SPDX-License-Identifier: Apache-2.0
// Where two bodies meet that come together fast. Between other shapes than boxes Bullet finds one
// point a tick and gathers them: a can that falls flat on its foot is stopped at one point of its
// rim, and tips. Only for bullet_*.cc. Tested by tests/physics/world/bounce_test.cc
#pragma once

#include <BulletCollision/CollisionDispatch/btConvexConvexAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>

namespace prehend::physics {

/// What comes together slower just touches, and does not bounce.
inline constexpr btScalar kSlowestImpact_m_per_s = 0.2;

/// Bullet's collisions, which find all of a face that hits another one within one tick. What is
/// slower, balls, hands and persons meet as ever.
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
