// SPDX-License-Identifier: Apache-2.0
// Kinematics of joints: their positions, and the motion that they leave free, from the poses of the
// joined bodies. No engine involved. Tested by tests/physics/scene/joint_test.cc
#pragma once

#include <cstddef>
#include <vector>

#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

/// State of the joint when its base and its body are at these poses.
JointState StateOf(const Scene& scene, const Joint& joint, const Pose& X_WBase, const Pose& X_WB);

/// Writes the states of all joints, from the poses of the bodies in the snapshot.
void DescribeJoints(const Scene& scene, Snapshot& snapshot);

/// The motion in the world that moves the joint's body by `change` (metres or radians) along the
/// free axis, with its base at X_WBase. The identity for joints without such an axis.
Pose MotionAlong(const Scene& scene, const Joint& joint, const Pose& X_WBase, double change);

/// Index of the joint that moves a body: its own, or for a body with a fixed joint that of its
/// base, and so on; -1: none.
int JointThatMoves(const Scene& scene, BodyIndex body);

/// The body at the end of its chain of fixed joints, or itself. All bodies with the same root are
/// one rigid body.
BodyIndex RootOf(const Scene& scene, BodyIndex body);

/// Whether the two are one rigid body or the two sides of a joint. Such bodies do not collide.
bool NeverTouch(const Scene& scene, BodyIndex body, BodyIndex other);

// Bodies that fixed joints tie together are one rigid body to an engine. Tested by
// tests/physics/scene/joint_test.cc

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
