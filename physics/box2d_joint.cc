// SPDX-License-Identifier: Apache-2.0
// Tested by tests/physics/box2d_world_test.cc
#include "physics/box2d_joint.h"

#include <algorithm>

namespace prehend::physics {
namespace {

/// 1 / kg m^2 about a point of the world.
double InverseMomentAbout(const b2Body& body, const b2Vec2& point) {
  if (body.GetType() != b2_dynamicBody) return 0;
  const double apart = (body.GetWorldCenter() - point).LengthSquared();
  return kTorqueScale / (MomentAboutCentre(body) + body.GetMass() * apart);
}

double InverseMass(const b2Body& body) {
  return body.GetType() == b2_dynamicBody ? 1.0 / body.GetMass() : 0;
}

}  // namespace

Box2dJoint::Box2dJoint(const Joint& joint, b2Body& base, b2Body& body, b2World& world)
    : joint_(joint), sign_(joint.kind != JointKind::kSlider && joint.axis_W.y() > 0 ? -1 : 1) {
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

double Box2dJoint::Position() const {
  return sign_ *
         (slider_ ? slider_->GetJointTranslation() / kLengthScale : hinge_->GetJointAngle());
}

double Box2dJoint::Rate() const {
  return sign_ * (slider_ ? slider_->GetJointSpeed() / kLengthScale : hinge_->GetJointSpeed());
}

double Box2dJoint::Inertia() const {
  if (slider_) return 1 / (InverseMass(*slider_->GetBodyA()) + InverseMass(*slider_->GetBodyB()));
  const b2Vec2 pivot = hinge_->GetAnchorA();
  return 1 / (InverseMomentAbout(*hinge_->GetBodyA(), pivot) +
              InverseMomentAbout(*hinge_->GetBodyB(), pivot));
}

void Box2dJoint::Pull(double dt_s) {
  if (joint_.spring == 0 && joint_.damping == 0) return;
  // As if at the end of the tick, and never more than what stops the joint there: no stiffness
  // explodes.
  const double resistance = joint_.damping + joint_.spring * dt_s;
  const double share = std::min(1.0, Inertia() / (resistance * dt_s));
  const double force = -share * (joint_.spring * (Position() - joint_.rest) + resistance * Rate());
  if (hinge_) {
    const auto torque = static_cast<float>(sign_ * force * kTorqueScale);
    hinge_->GetBodyA()->ApplyTorque(-torque, false);
    hinge_->GetBodyB()->ApplyTorque(torque, false);
    return;
  }
  const b2Vec2 along = static_cast<float>(force * kLengthScale) *
                       slider_->GetBodyA()->GetWorldVector(slider_->GetLocalAxisA());
  const b2Vec2 at = slider_->GetAnchorB();
  slider_->GetBodyA()->ApplyForce(-along, at, false);
  slider_->GetBodyB()->ApplyForce(along, at, false);
}

}  // namespace prehend::physics
