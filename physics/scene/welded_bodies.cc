// SPDX-License-Identifier: Apache-2.0
// Tested by tests/physics/scene/joint_test.cc
#include "physics/scene/welded_bodies.h"

#include "physics/scene/geometry.h"
#include "physics/scene/joint.h"

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

namespace {

/// Where the centre of mass of a shape is; most shapes have their frame there.
Pose CentreOf(const Shape& shape, const Pose& X_RS) {
  const auto* hull = std::get_if<Hull>(&shape);
  return hull ? X_RS * hull->X_SC : X_RS;  // the others keep their pose to the last bit
}

}  // namespace

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
      // So do the root's own shapes.
      const Pose X_RS = i == 0 ? placed.X_BS : X_RW * body.X_WB * placed.X_BS;
      members.push_back(
          {&placed, i, CentreOf(placed.shape, X_RS), density * VolumeOf(placed.shape)});
    }
  }
  return members;
}

}  // namespace prehend::physics
