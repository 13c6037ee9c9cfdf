// SPDX-License-Identifier: Apache-2.0
// Bullet's narrow phase, for the pairs of which one is awake. Bullet sorts all pairs that overlap
// in every tick, because determinism needs an order, and then does nothing for those that sleep.
// Normals of points that stay are turned with their bodies (physics/bullet/core/contact_normals.h).
// Only for bullet_*.cc. Tested by tests/physics/world/world_test.cc
#pragma once

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include <vector>

#include "physics/bullet/core/contact_normals.h"

namespace prehend::physics {

class BulletDispatcher final : public btCollisionDispatcher {
 public:
  using btCollisionDispatcher::btCollisionDispatcher;

  /// In the order that Bullet's `m_deterministicOverlappingPairs` asks for, whether that is set or
  /// not.
  void dispatchAllCollisionPairs(btOverlappingPairCache* cache, const btDispatcherInfo& info,
                                 btDispatcher* dispatcher) override;

  /// Contacts of pairs of which one was awake when the last step began. Until the next step.
  const btManifoldArray& AwakeManifolds();
  /// Contacts of all pairs. Until the next step.
  const btManifoldArray& AllManifolds();

 private:
  std::vector<btBroadphasePair*> awake_;  ///< of the present tick
  CarriedNormals normals_;
  btManifoldArray manifolds_;
};

}  // namespace prehend::physics
