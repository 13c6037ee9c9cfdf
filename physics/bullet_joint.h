// SPDX-License-Identifier: Apache-2.0
// A joint between two bodies in Bullet: one kind of constraint with six axes, of which the joint
// frees some. Only for bullet_*.cc. Tested by tests/physics/joint_test.cc
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>

#include "physics/scene.h"

namespace prehend::physics {

class BulletJoint {
 public:
  /// A slider, hinge or ball; fixed joints need none, their bodies are one (BulletBody). The bodies
  /// must stand as placed.
  BulletJoint(const Joint& joint, btRigidBody& base, btRigidBody& body);

  /// For the coming tick: how far it is to the limits, spring and damping. Friction and limits are
  /// rows of the constraint.
  void Prepare(double dt_s);
  btTypedConstraint& constraint() { return *constraint_; }

 private:
  void Pull(double position, double dt_s);

  Joint joint_;
  std::unique_ptr<btGeneric6DofSpring2Constraint> constraint_;
};

}  // namespace prehend::physics
