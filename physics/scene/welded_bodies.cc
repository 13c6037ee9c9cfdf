// SPDX-License-Identifier: Apache-2.0
// The root of a body is found along its fixed joints (physics/scene/joint.h). Tested by
// tests/physics/scene/joint_test.cc
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
    const auto root = RootOf(scene, BodyIndex(i)).index();
    if (root == i) continue;
    groups[root].push_back(i);
    groups[i].clear();
  }
  std::erase_if(groups, [](const auto& group) { return group.empty(); });
  return groups;
}

namespace {

/// The frame of a shape's centre of mass; for most shapes it is the shape's own frame.
Pose CentreOf(const Shape& shape, const Pose& X_RS) {
  const auto* hull = std::get_if<Hull>(&shape);
  return hull ? X_RS * hull->X_SC : X_RS;  // the other shapes keep their pose to the last bit
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
      // The root's own shapes keep their pose to the last bit, too.
      const Pose X_RS = i == 0 ? placed.X_BS : X_RW * body.X_WB * placed.X_BS;
      members.push_back(
          {&placed, i, CentreOf(placed.shape, X_RS), density * VolumeOf(placed.shape)});
    }
  }
  return members;
}

}  // namespace prehend::physics
