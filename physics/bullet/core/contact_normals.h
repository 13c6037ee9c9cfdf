// SPDX-License-Identifier: Apache-2.0
// Normals of contact points that Bullet keeps from tick to tick. It moves the points with their
// bodies, but leaves their normals as they were found; and while two boxes rest on each other
// without being in each other, none is found anew. So a box would lie still on a board that tips
// over, held by normals that point up. Only for bullet_*.cc. Tested by
// tests/physics/world/tipping_test.cc
#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <vector>

namespace prehend::physics {

/// Turns kept normals with their bodies, as far as both turn together. What touches something that
/// does not turn, or a hand, keeps its normals to the last bit.
class CarriedNormals {
 public:
  /// After the narrow phase of a tick, once for each manifold of which a body may have moved.
  void Carry(btPersistentManifold& manifold) const;
  /// Afterwards, once or more for each body that may have moved.
  void Remember(const btCollisionObject& body);

 private:
  bool Turned(const btCollisionObject& body) const;
  /// Where the body has carried the normal in this tick, from where it was.
  btVector3 WayOf(const btVector3& normal, const btCollisionObject& body) const;

  struct Before {
    btMatrix3x3 R_WB;
    bool known = false;
  };
  std::vector<Before> before_;  ///< by index of the body in its world
};

}  // namespace prehend::physics
