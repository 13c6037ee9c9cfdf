// SPDX-License-Identifier: Apache-2.0
// Bullet's narrow phase for pairs with at least one body awake. Bullet sorts all overlapping pairs
// in every tick, because determinism needs an order, and then skips those that sleep. Normals of
// kept contact points are rotated with their bodies (physics/bullet/core/dispatcher.h). Only
// for physics/bullet. Tested by tests/physics/world/world_test.cc
#pragma once

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <cstdint>
#include <vector>

namespace prehend::physics {

// Normals of contact points that Bullet keeps from tick to tick. Bullet moves kept points with
// their bodies but not their normals, and while two boxes rest on each other without overlap no
// point is found anew. A box would therefore lie still on a tilting board, held by normals that
// point up. Only for physics/bullet. Tested by tests/physics/world/tipping_test.cc

/// Rotates kept normals with their bodies, links of hands among them, as far as both rotate
/// together. A contact with a body that does not rotate keeps its normal to the last bit.
class CarriedNormals {
 public:
  /// Call after the narrow phase of a tick, once for each manifold with a body that may have moved.
  void Carry(btPersistentManifold& manifold) const;
  /// Call afterwards, at least once for each body that may have moved.
  void Remember(const btCollisionObject& body);

 private:
  bool Turned(const btCollisionObject& body) const;
  /// Change of the normal by the body's rotation in this tick.
  btVector3 WayOf(const btVector3& normal, const btCollisionObject& body) const;

  struct Before {
    btMatrix3x3 R_WB;
    bool known = false;
  };
  std::vector<Before> before_;  ///< by index of the body in its world
};

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
