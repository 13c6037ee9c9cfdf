// SPDX-License-Identifier: Apache-2.0
// Contact facts, read from Bullet's manifolds after a step (under 1 % of a tick). Only for
// bullet_*.cc. Tested by tests/physics/world/world_test.cc
#pragma once

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

#include <vector>

#include "physics/world/contact_hold.h"

namespace prehend::physics {

/// Who a collision object is, or for a compound whose shapes belong to several bodies, who each of
/// its shapes is. The world gives every object its index here as Bullet's user index.
using ContactSides = std::vector<std::vector<ContactSide>>;

/// Whose shape this is; `shape` is the index that Bullet gives to a compound's shape.
const ContactSide& SideOf(const ContactSides& sides, const btCollisionObject& object, int shape);

/// After every step, between the pairs' BeginTick() and EndTick().
void ReadContacts(const btManifoldArray& manifolds, const ContactSides& sides,
                  TouchingPairs& pairs);

}  // namespace prehend::physics
