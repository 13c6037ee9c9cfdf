// SPDX-License-Identifier: Apache-2.0
// Normals of contact points that Bullet keeps from tick to tick. Bullet moves kept points with
// their bodies but not their normals, and while two boxes rest on each other without overlap no
// point is found anew. A box would therefore lie still on a tilting board, held by normals that
// point up. Only for physics/bullet. Tested by tests/physics/world/tipping_test.cc
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <vector>

namespace prehend::physics {

/// Rotates kept normals with their bodies, as far as both rotate together. A contact with a body
/// that does not rotate, or with a hand, keeps its normal to the last bit.
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

}  // namespace prehend::physics
