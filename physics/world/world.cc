// SPDX-License-Identifier: Apache-2.0
// What an engine need not have: one without persons moves no kinematic bodies and sees nothing.
#include "physics/world/world.h"

namespace prehend::physics {

void World::MoveKinematic(int, const Pose&) {}
Sight World::Look(const SightLine&) const { return {}; }

}  // namespace prehend::physics
