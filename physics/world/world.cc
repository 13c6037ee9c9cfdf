// SPDX-License-Identifier: Apache-2.0
// Defaults for engines without persons.
#include "physics/world/world.h"

namespace prehend::physics {

void World::MoveKinematic(BodyIndex, const Pose&, bool) {}
Sight World::Look(const SightLine&) const { return {}; }

}  // namespace prehend::physics
