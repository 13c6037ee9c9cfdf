// SPDX-License-Identifier: Apache-2.0
// Bullet's narrow phase for pairs with at least one body awake. Bullet sorts all overlapping pairs
// in every tick, because determinism needs an order, and then skips those that sleep. Normals of
// kept contact points are rotated with their bodies (physics/bullet/core/contact_normals.h). Only
// for physics/bullet. Tested by tests/physics/world/world_test.cc
#pragma once

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include <cstdint>
#include <vector>

#include "physics/bullet/core/contact_normals.h"

namespace prehend::physics {

class BulletDispatcher final : public btCollisionDispatcher {
 public:
  using btCollisionDispatcher::btCollisionDispatcher;

  /// Dispatches in the order of Bullet's `m_deterministicOverlappingPairs`, whether that is set or
  /// not.
  void dispatchAllCollisionPairs(btOverlappingPairCache* cache, const btDispatcherInfo& info,
                                 btDispatcher* dispatcher) override;

  /// Contacts of pairs with a body that was awake when the last step began. Valid until the next
  /// step.
  const btManifoldArray& AwakeManifolds() const { return awake_manifolds_; }
  /// Contacts of all pairs. Valid until the next step.
  const btManifoldArray& AllManifolds() const { return m_manifoldsPtr; }

 private:
  struct AwakePair {
    std::uint64_t ids;  ///< of its proxies, the first one higher: pairs are sorted by it
    btBroadphasePair* pair;
  };
  std::vector<AwakePair> awake_;  ///< pairs of the present tick
  CarriedNormals normals_;
  btManifoldArray awake_manifolds_;
};

}  // namespace prehend::physics
