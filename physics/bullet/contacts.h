// SPDX-License-Identifier: Apache-2.0
// Reads contact facts from Bullet's manifolds after a step (less than 1 % of a tick). Only for
// physics/bullet. Tested by tests/physics/world/world_test.cc
#pragma once

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <btBulletCollisionCommon.h>

#include <vector>

#include "physics/world/contact_hold.h"
#include "physics/world/world.h"

namespace prehend::physics {

/// By collision object, its contact side; for a compound whose shapes belong to several bodies, one
/// side per shape. A collision object's user index in Bullet is its index here.
using ContactSides = std::vector<std::vector<ContactSide>>;

/// The side that this shape belongs to; `shape` is Bullet's index of the shape in a compound.
const ContactSide& SideOf(const ContactSides& sides, const btCollisionObject& object, int shape);

/// Call after every step, between the pairs' BeginTick() and EndTick().
void ReadContacts(const btManifoldArray& manifolds, const ContactSides& sides,
                  TouchingPairs& pairs);

// What a person sees: the first surface that a sphere meets on its way from her eyes. Only for
// physics/bullet. Tested by tests/physics/person/gaze_test.cc

Sight FirstInSight(const btCollisionWorld& world, const ContactSides& sides, const SightLine& line);

}  // namespace prehend::physics
