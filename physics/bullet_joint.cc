// SPDX-License-Identifier: Apache-2.0
// Tested by tests/physics/joint_test.cc
#include "physics/bullet_joint.h"

#include "physics/bullet_convert.h"

namespace prehend::physics {
namespace {

// The constraint's frame has its x axis along the joint's axis. Axes 0..2 shift along x, y, z, axes
// 3..5 turn about them.
constexpr int kShiftAlongAxis = 0;
constexpr int kTurnAboutAxis = 3;

/// How firmly a limit is restored per tick, as everywhere (bullet_world.cc).
constexpr double kStopErrorReduction = 0.2;

using Constraint = btGeneric6DofSpring2Constraint;

/// Friction is a motor that wants speed 0 and has little strength; damping and spring have rows of
/// their own.
void Resist(Constraint& constraint, int axis, const Joint& joint) {
  constraint.enableMotor(axis, joint.friction > 0);
  constraint.setTargetVelocity(axis, 0);
  constraint.setMaxMotorForce(axis, joint.friction);
  constraint.enableSpring(axis, joint.spring > 0 || joint.damping > 0);
  constraint.setStiffness(axis, joint.spring, false);
  constraint.setDamping(axis, joint.damping, false);
  constraint.setEquilibriumPoint(axis, joint.rest);
}

}  // namespace

std::unique_ptr<btTypedConstraint> MakeConstraint(const Joint& joint, btRigidBody& base,
                                                  btRigidBody& body) {
  // Bullet counts these angles from the body to its base, the other way round than ours.
  const Eigen::Vector3d axis_W = joint.kind == JointKind::kHinge ? -joint.axis_W : joint.axis_W;
  const Pose X_WJ{joint.pivot_W_m,
                  Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), axis_W)};
  const auto in_body = [&](const btRigidBody& owner) {
    return owner.getCenterOfMassTransform().inverse() * ToBullet(X_WJ);
  };
  auto constraint = std::make_unique<Constraint>(base, body, in_body(base), in_body(body));
  for (int axis = 0; axis < 6; ++axis) {
    constraint->setLimit(axis, 0, 0);
    constraint->setParam(BT_CONSTRAINT_STOP_ERP, kStopErrorReduction, axis);
  }
  if (joint.kind == JointKind::kBall) {
    for (int axis = 3; axis < 6; ++axis) constraint->setLimit(axis, 1, -1);  // none
  } else {
    const int axis = joint.kind == JointKind::kSlider ? kShiftAlongAxis : kTurnAboutAxis;
    constraint->setLimit(axis, joint.lower, joint.upper);
    Resist(*constraint, axis, joint);
  }
  return constraint;
}

}  // namespace prehend::physics
