// SPDX-License-Identifier: Apache-2.0
// A joint between two bodies in Bullet: one kind of constraint with six axes, of which the joint
// frees some. Only for bullet_*.cc. Tested by tests/physics/scene/joint_test.cc
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>

#include "physics/scene/joint_spring.h"
#include "physics/scene/scene.h"

namespace prehend::physics {

class BulletJoint {
 public:
  /// A slider, hinge or ball; fixed joints need none, their bodies are one (BulletBody). The bodies
  /// must stand as placed.
  /// `sharers`: see SpringForce.
  BulletJoint(const Joint& joint, int sharers, btRigidBody& base, btRigidBody& body);

  /// For the coming tick: how far it is to the limits, spring and damping. Friction and limits are
  /// rows of the constraint. Nothing moves yet: joints that share a body all read what the last
  /// tick left.
  void Prepare(double dt_s);
  /// After all joints are prepared.
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
