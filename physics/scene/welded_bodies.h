// SPDX-License-Identifier: Apache-2.0
// Bodies that fixed joints tie together are one rigid body to an engine. Tested by
// tests/physics/scene/joint_test.cc
#pragma once

#include <cstddef>
#include <vector>

#include "physics/scene/scene.h"

namespace prehend::physics {

/// Groups of indices into Scene::bodies, each with its root first, sorted by root. Every body of
/// the scene is in exactly one group.
std::vector<std::vector<std::size_t>> RigidGroups(const Scene& scene);

/// A shape of one of the bodies that make up a rigid body.
struct RigidMember {
  const PlacedShape* placed = nullptr;
  std::size_t owner = 0;  ///< index into the bodies
  Pose X_RC;              ///< centre of mass and principal axes, in the frame of the root
  double mass_kg = 0;     ///< of a fixed body: its volume, as if its density were 1
};

/// All shapes of the bodies. A body's mass is distributed over its shapes by volume. The bodies
/// must outlive the result.
std::vector<RigidMember> MembersOf(const std::vector<const Body*>& bodies);

}  // namespace prehend::physics
