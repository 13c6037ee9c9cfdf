// SPDX-License-Identifier: Apache-2.0
// A joint between two bodies in Bullet: one constraint with six axes, some of which are free. Only
// for physics/bullet. Tested by tests/physics/scene/joint_test.cc
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>

#include "physics/scene/scene.h"
#include "physics/world/joint_spring.h"

namespace prehend::physics {

class BulletJoint {
 public:
  /// A slider, hinge or ball joint; a fixed joint needs no constraint, because its bodies are one
  /// (BulletBody). The bodies must still be at their initial poses. `sharers`: see SpringForce.
  BulletJoint(const Joint& joint, int sharers, btRigidBody& base, btRigidBody& body);

  /// Computes spring, damping and the distance to the limits for the coming tick. Friction and
  /// limits are rows of the constraint. Nothing moves yet, so that joints that share a body all
  /// read the state after the last tick.
  void Prepare(double dt_s);
  /// Applies spring and damping; call after all joints are loaded.
  void Pull();
  btTypedConstraint& constraint() { return *constraint_; }

 private:
  JointPlace Place(double position) const;

  Joint joint_;
  int sharers_;
  double impulse_ = 0;  ///< of spring and damping in the coming tick: N s or N m s
  std::unique_ptr<btGeneric6DofSpring2Constraint> constraint_;
};

}  // namespace prehend::physics
