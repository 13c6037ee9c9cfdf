// SPDX-License-Identifier: Apache-2.0
// Leaves out contacts between grains of one body and contacts between bodies that rest. Tested by
// tests/physics/world/world_test.cc
#include "physics/bullet/contacts.h"

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include "physics/bullet/convert.h"

namespace prehend::physics {

const ContactSide& SideOf(const ContactSides& sides, const btCollisionObject& object, int shape) {
  const auto& of_object = sides[static_cast<std::size_t>(object.getUserIndex())];
  return of_object[of_object.size() == 1 ? 0 : static_cast<std::size_t>(shape)];
}

void ReadContacts(const btManifoldArray& manifolds, const ContactSides& sides,
                  TouchingPairs& pairs) {
  for (int m = 0; m < manifolds.size(); ++m) {
    const btPersistentManifold& manifold = *manifolds[m];
    // Grains of one body touch each other in every tick; these contacts are not reported.
    if (manifold.getBody0()->getUserIndex() == manifold.getBody1()->getUserIndex()) continue;
    // All shapes of one collision object rest or move together: the first one decides.
    if (pairs.Rest(SideOf(sides, *manifold.getBody0(), 0), SideOf(sides, *manifold.getBody1(), 0)))
      continue;
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
      const btManifoldPoint& point = manifold.getContactPoint(k);
      // Bullet's normal points from body 1 into body 0.
      pairs.Add({.a = SideOf(sides, *manifold.getBody0(), point.m_index0),
                 .b = SideOf(sides, *manifold.getBody1(), point.m_index1),
                 .p_W_m = FromBullet(point.getPositionWorldOnB()),
                 .nhat_BA_W = FromBullet(point.m_normalWorldOnB),
                 .distance_m = point.getDistance(),
                 .normal_impulse_n_s = point.getAppliedImpulse()});
    }
  }
}

}  // namespace prehend::physics
