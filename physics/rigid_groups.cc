// SPDX-License-Identifier: Apache-2.0
// Tested by tests/physics/joint_test.cc
#include "physics/rigid_groups.h"

#include "physics/geometry.h"
#include "physics/joint.h"

namespace prehend::physics {

std::vector<std::vector<std::size_t>> RigidGroups(const Scene& scene) {
  const std::size_t count = scene.bodies.size();
  std::vector<std::vector<std::size_t>> groups(count);  // by root, the root itself first
  for (std::size_t i = 0; i < count; ++i) {
    if (!scene.bodies[i].grains) groups[i].push_back(i);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto root = static_cast<std::size_t>(RootOf(scene, static_cast<int>(i)));
    if (root == i) continue;
    groups[root].push_back(i);
    groups[i].clear();
  }
  std::erase_if(groups, [](const auto& group) { return group.empty(); });
  return groups;
}

std::vector<RigidMember> MembersOf(const std::vector<const Body*>& bodies) {
  std::vector<RigidMember> members;
  const Pose X_RW = bodies.front()->X_WB.inverse();
  const bool fixed = bodies.front()->fixed;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Body& body = *bodies[i];
    double volume = 0;
    for (const PlacedShape& placed : body.shapes) volume += VolumeOf(placed.shape);
    const double density = (fixed ? 1.0 : body.mass_kg) / volume;
    for (const PlacedShape& placed : body.shapes) {
      // The root's own shapes keep their pose to the last bit.
      const Pose X_RS = i == 0 ? placed.X_BS : X_RW * body.X_WB * placed.X_BS;
      members.push_back({&placed, i, X_RS, density * VolumeOf(placed.shape)});
    }
  }
  return members;
}

}  // namespace prehend::physics
