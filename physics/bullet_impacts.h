// SPDX-License-Identifier: Apache-2.0
// Where two bodies meet that come together fast. Between other shapes than boxes Bullet finds one
// point a tick and gathers them: a can that falls flat on its foot is stopped at one point of its
// rim, and tips. Only for bullet_*.cc. Tested by tests/physics/bounce_test.cc
#pragma once

#include <BulletCollision/CollisionDispatch/btConvexConvexAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>

namespace prehend::physics {

/// Bullet's collisions, which find all of a face that hits another one within one tick. What comes
/// together slower than `slowest_m_per_s`, balls, hands and persons meet as ever.
class ImpactConfiguration final : public btDefaultCollisionConfiguration {
 public:
  explicit ImpactConfiguration(btScalar slowest_m_per_s);
  btCollisionAlgorithmCreateFunc* getCollisionAlgorithmCreateFunc(int type0, int type1) override;

 private:
  struct Impacts final : btConvexConvexAlgorithm::CreateFunc {
    using btConvexConvexAlgorithm::CreateFunc::CreateFunc;
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override;
    btScalar slowest_m_per_s = 0;
  };
  Impacts impacts_;
};

}  // namespace prehend::physics
