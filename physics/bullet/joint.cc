// SPDX-License-Identifier: Apache-2.0
// A btGeneric6DofSpring2Constraint with limits, and a friction motor on the free axis. Tested by
// tests/physics/scene/joint_test.cc
#include "physics/bullet/joint.h"

#include "physics/bullet/convert.h"

namespace prehend::physics {
namespace {

// The x axis of the constraint's frame is the joint's axis. Axes 0..2 are translations along x, y,
// z; axes 3..5 are rotations about them.
constexpr int kShiftAlongAxis = 0;
constexpr int kTurnAboutAxis = 3;

/// Share of a limit violation that is removed per tick, as for contacts (physics/bullet/world.cc).
constexpr double kStopErrorReduction = 0.2;
/// The distance that is left to a limit may be closed within the tick, like the gap of a contact.
/// With a smaller value Bullet brakes a fast body before it arrives: a drawer at 1.4 m/s over its
/// last 15 mm.
constexpr double kWholeWay = 1;
/// With a bounce of 0 Bullet stops a body that would arrive within the tick at its present place.
constexpr double kKeepSpeedUntilThere = -1;

/// Friction is a motor with target speed 0 and limited strength.
void Rub(btGeneric6DofSpring2Constraint& constraint, int axis, double friction) {
  constraint.enableMotor(axis, friction > 0);
  constraint.setTargetVelocity(axis, 0);
  constraint.setMaxMotorForce(axis, friction);
}

/// A body that a spring pulls slowly has not arrived yet. Below this speed it is within half a
/// millimetre of its rest position, even if strong damping makes it creep for many seconds.
constexpr double kSprungSleepSpeed_m_per_s = 1e-4;
constexpr double kSprungSleepTurn_rad_per_s = 5e-4;

JointSide SideOf(const btRigidBody& body) {
  JointSide side{.per_mass = body.getInvMass(),
                 .centre_W_m = FromBullet(body.getCenterOfMassPosition()),
                 .v_m_per_s = FromBullet(body.getLinearVelocity()),
                 .w_rad_per_s = FromBullet(body.getAngularVelocity())};
  for (int row = 0; row < 3; ++row)
    side.per_moment_W.row(row) = FromBullet(body.getInvInertiaTensorWorld()[row]);
  return side;
}

}  // namespace

BulletJoint::BulletJoint(const Joint& joint, int sharers, btRigidBody& base, btRigidBody& body)
    : joint_(joint), sharers_(sharers) {
  // Bullet measures these angles from the body to its base, opposite to ours.
  const Eigen::Vector3d axis_W = joint.kind == JointKind::kHinge ? -joint.axis_W : joint.axis_W;
  // A slider's pivot is its body's centre of mass: then neither its axis forces nor its limit
  // forces have a lever arm to rotate the body.
  const Eigen::Vector3d pivot_W_m = joint.kind == JointKind::kSlider
                                        ? FromBullet(body.getCenterOfMassPosition())
                                        : joint.pivot_W_m;
  const Pose X_WJ{pivot_W_m, RotationBetween(Eigen::Vector3d::UnitX(), axis_W)};
  const auto in_body = [&](const btRigidBody& owner) {
    return owner.getCenterOfMassTransform().inverse() * ToBullet(X_WJ);
  };
  constraint_ =
      std::make_unique<btGeneric6DofSpring2Constraint>(base, body, in_body(base), in_body(body));
  for (int axis = 0; axis < 6; ++axis) {
    constraint_->setLimit(axis, 0, 0);
    constraint_->setParam(BT_CONSTRAINT_STOP_ERP, kStopErrorReduction, axis);
  }
  if (joint.spring > 0) {
    for (btRigidBody* side : {&base, &body})
      side->setSleepingThresholds(kSprungSleepSpeed_m_per_s, kSprungSleepTurn_rad_per_s);
  }
  if (joint.kind == JointKind::kBall) {
    for (int axis = 3; axis < 6; ++axis) constraint_->setLimit(axis, 1, -1);  // no limits
  } else {
    const int axis = joint.kind == JointKind::kSlider ? kShiftAlongAxis : kTurnAboutAxis;
    constraint_->setLimit(axis, joint.lower, joint.upper);
    constraint_->setBounce(axis, kKeepSpeedUntilThere);
    Rub(*constraint_, axis, joint.friction);
  }
}

void BulletJoint::Prepare(double dt_s) {
  btRigidBody &base = constraint_->getRigidBodyA(), &body = constraint_->getRigidBodyB();
  if (joint_.kind == JointKind::kBall || !(base.isActive() || body.isActive())) return;
  constraint_->calculateTransforms();
  const bool slides = joint_.kind == JointKind::kSlider;
  const double position =
      slides ? constraint_->getRelativePivotPosition(kShiftAlongAxis) : constraint_->getAngle(0);
  const bool within = position >= joint_.lower && position <= joint_.upper;
  constraint_->setParam(BT_CONSTRAINT_STOP_ERP, within ? kWholeWay : kStopErrorReduction,
                        slides ? kShiftAlongAxis : kTurnAboutAxis);
  // Impulses, not forces: Bullet's friction ignores the effect of a torque within the tick, and an
  // object that lies on the body would creep.
  impulse_ =
      dt_s * SpringForce(joint_, Place(position), sharers_, SideOf(base), SideOf(body), dt_s);
}

JointPlace BulletJoint::Place(double position) const {
  const btTransform& X_WJ = constraint_->getCalculatedTransformA();
  const Eigen::Vector3d x_W = FromBullet(X_WJ.getBasis().getColumn(0));
  return {position, joint_.kind == JointKind::kSlider ? x_W : -x_W, FromBullet(X_WJ.getOrigin())};
}

void BulletJoint::Pull() {
  if (impulse_ == 0) return;
  btRigidBody &base = constraint_->getRigidBodyA(), &body = constraint_->getRigidBodyB();
  const btVector3 push = ToBullet(impulse_ * Place(0).axis_W);
  impulse_ = 0;
  if (joint_.kind == JointKind::kSlider) {
    body.applyCentralImpulse(push);
    base.applyImpulse(-push, body.getCenterOfMassPosition() - base.getCenterOfMassPosition());
  } else {
    body.applyTorqueImpulse(push);
    base.applyTorqueImpulse(-push);
  }
}

}  // namespace prehend::physics
