// SPDX-License-Identifier: Apache-2.0
// Friction is a motor of speed 0 with limited strength. Tested by tests/physics/box2d/world_test.cc
#include "physics/box2d/joint.h"

#include "physics/world/joint_spring.h"

namespace prehend::physics {
namespace {

JointSide SideOf(const b2Body& body) {
  const bool moves = body.GetType() == b2_dynamicBody;
  const double per_moment = moves ? kTorqueScale / MomentAboutCentre(body) : 0;
  return {.per_mass = moves ? 1.0 / body.GetMass() : 0,
          .per_moment_W = per_moment * Eigen::Matrix3d::Identity(),  // it rotates about y only
          .centre_W_m = FromBox2d(body.GetWorldCenter()),
          .v_m_per_s = FromBox2d(body.GetLinearVelocity()),
          .w_rad_per_s = {0, -body.GetAngularVelocity(), 0}};
}

}  // namespace

Box2dJoint::Box2dJoint(const Joint& joint, int sharers, b2Body& base, b2Body& body, b2World& world)
    : joint_(joint),
      sharers_(sharers),
      sign_(joint.kind != JointKind::kSlider && joint.axis_W.y() > 0 ? -1 : 1) {
  if (joint.spring > 0) {
    // Box2D has one sleeping speed for all bodies, and a spring may pull more slowly than that.
    for (b2Body* side : {&base, &body}) side->SetSleepingAllowed(false);
  }
  const float friction = static_cast<float>(joint.friction);
  if (joint.kind == JointKind::kSlider) {
    b2PrismaticJointDef def;
    def.Initialize(&base, &body, body.GetPosition(), DirectionToBox2d(joint.axis_W));
    def.enableLimit = true;
    SetLimits(joint.lower, joint.upper, kLengthScale, def.lowerTranslation, def.upperTranslation);
    def.enableMotor = joint.friction > 0;
    def.maxMotorForce = friction * static_cast<float>(kLengthScale);
    slider_ = static_cast<b2PrismaticJoint*>(world.CreateJoint(&def));
  } else {
    b2RevoluteJointDef def;
    def.Initialize(&base, &body, ToBox2d(joint.pivot_W_m));
    def.enableLimit = joint.kind == JointKind::kHinge;
    SetLimits(joint.lower, joint.upper, sign_, def.lowerAngle, def.upperAngle);
    def.enableMotor = joint.friction > 0;
    def.maxMotorTorque = friction * static_cast<float>(kTorqueScale);
    hinge_ = static_cast<b2RevoluteJoint*>(world.CreateJoint(&def));
  }
}

void Box2dJoint::Pull(double dt_s) {
  if (joint_.spring == 0 && joint_.damping == 0) return;
  if (hinge_) {
    b2Body &base = *hinge_->GetBodyA(), &body = *hinge_->GetBodyB();
    const JointPlace place{
        sign_ * hinge_->GetJointAngle(), {0, -sign_, 0}, FromBox2d(hinge_->GetAnchorA())};
    const auto torque =
        static_cast<float>(sign_ * kTorqueScale *
                           SpringForce(joint_, place, sharers_, SideOf(base), SideOf(body), dt_s));
    base.ApplyTorque(-torque, false);
    body.ApplyTorque(torque, false);
  } else {
    b2Body &base = *slider_->GetBodyA(), &body = *slider_->GetBodyB();
    const Eigen::Vector3d axis_W =
        FromBox2d(base.GetWorldVector(slider_->GetLocalAxisA())) * kLengthScale;
    const JointPlace place{slider_->GetJointTranslation() / kLengthScale, axis_W, {0, 0, 0}};
    const b2Vec2 force =
        ToBox2d(SpringForce(joint_, place, sharers_, SideOf(base), SideOf(body), dt_s) * axis_W);
    base.ApplyForce(-force, body.GetWorldCenter(), false);
    body.ApplyForceToCenter(force, false);
  }
}

}  // namespace prehend::physics
