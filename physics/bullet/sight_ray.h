// SPDX-License-Identifier: Apache-2.0
// What a person sees: the first surface that a sphere meets on its way from her eyes. Only for
// physics/bullet. Tested by tests/physics/person/gaze_test.cc
#pragma once

#include <btBulletCollisionCommon.h>

#include "physics/bullet/contacts.h"
#include "physics/world/world.h"

namespace prehend::physics {

Sight FirstInSight(const btCollisionWorld& world, const ContactSides& sides, const SightLine& line);

}  // namespace prehend::physics
