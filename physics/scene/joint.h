// SPDX-License-Identifier: Apache-2.0
// What follows from where joined bodies stand: a joint's position, and the way that it leaves free.
// No engine involved. Tested by tests/physics/scene/joint_test.cc
#pragma once

#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

/// Where the joint stands when its base and its body stand at these poses.
JointState StateOf(const Scene& scene, const Joint& joint, const Pose& X_WBase, const Pose& X_WB);

/// Where all joints stand, from the poses of the bodies in the snapshot.
void DescribeJoints(const Scene& scene, Snapshot& snapshot);

/// The motion in the world that takes the joint's body by `change` (metres or radians) along the
/// joint's free way, with its base at X_WBase. The identity for joints that have no such way.
Pose MotionAlong(const Scene& scene, const Joint& joint, const Pose& X_WBase, double change);

/// The joint that moves a body: its own, or for a body with a fixed joint that of its base, and so
/// on. -1: none.
int JointThatMoves(const Scene& scene, int body);

/// The body that carries it by fixed joints, or itself: all bodies with one root are one rigid
/// body.
int RootOf(const Scene& scene, int body);

/// Are the two one rigid body, or the two sides of a joint? Such bodies go through each other.
bool NeverTouch(const Scene& scene, int body, int other);

}  // namespace prehend::physics
