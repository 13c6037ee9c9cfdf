// SPDX-License-Identifier: Apache-2.0
// Bodies that fixed joints tie together are one rigid body to an engine. Tested by
// tests/physics/scene/joint_test.cc
#pragma once

#include <cstddef>
#include <vector>

#include "physics/scene/scene.h"

namespace prehend::physics {

/// Every body of the scene in exactly one group, which lists indices into Scene::bodies, the root
/// first. Sorted by root.
std::vector<std::vector<std::size_t>> RigidGroups(const Scene& scene);

/// A shape of one of the bodies that make up a rigid body.
struct RigidMember {
  const PlacedShape* placed = nullptr;
  std::size_t owner = 0;  ///< index into the bodies
  Pose X_RC;  ///< its centre of mass and principal axes, in the frame of the first body, the root
  double mass_kg = 0;  ///< of a fixed body: as if its density were 1
};

/// The mass of a body is spread evenly over its shapes' volumes. The bodies outlive the result.
std::vector<RigidMember> MembersOf(const std::vector<const Body*>& bodies);

}  // namespace prehend::physics
