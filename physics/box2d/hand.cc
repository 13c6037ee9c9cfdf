// SPDX-License-Identifier: Apache-2.0
// One Box2D body per part of the hand; each link hangs on its parent by a revolute or a prismatic
// joint with a motor.
#include "physics/box2d/hand.h"

#include <algorithm>

#include "physics/scene/planar.h"

namespace prehend::physics {
namespace {

Eigen::Vector3d SizeOf(const HandLink& link) {
  return {link.length_m, 2 * link.half_width_m, 2 * link.half_thickness_m};
}

}  // namespace

Box2dHand::Box2dHand(const Hand& hand, HandIndex index, int style, b2World& world,
                     FixtureTable& table)
    : model_(hand.model),
      index_(index),
      pids_(hand.model),
      command_{.target = {.X_WH = hand.X_WH}, .style = style},
      palm_(MakePart(kNone, hand.X_WH, model_.palm_size_m, model_.palm_mass_kg,
                     model_.palm_inertia_scale, world, table)) {
  const std::vector<double> joints =
      JointTargets(model_.styles[static_cast<std::size_t>(style)], 0);
  const std::vector<Pose> X_HL = LinkPoses(model_, joints),
                          rest = LinkPoses(model_, std::vector<double>(joints.size(), 0.0));
  for (std::size_t i = 0; i < model_.links.size(); ++i) {
    const HandLink& link = model_.links[i];
    const Pose X_WL = hand.X_WH * X_HL[i];
    links_.push_back(MakePart(LinkIndex(i), X_WL, SizeOf(link), link.mass_kg, 1, world, table));
    // A joint's own motion does not move its axis.
    const Eigen::Vector3d axis_W = X_WL.q * (rest[i].q.conjugate() * link.joint_axis);
    const Eigen::Vector3d pivot_W_m = X_WL * Eigen::Vector3d(-link.length_m / 2, 0, 0);
    b2Body& parent = link.parent == kNone ? *palm_.body : *At(links_, link.parent).body;
    motors_.push_back(MakeMotor(link, axis_W, pivot_W_m, joints[i], parent, *links_.back().body));
  }
}

Box2dHand::Part Box2dHand::MakePart(LinkIndex link, const Pose& X_WL, const Eigen::Vector3d& size_m,
                                    double mass_kg, double inertia_scale, b2World& world,
                                    FixtureTable& table) {
  b2BodyDef def;
  def.type = b2_dynamicBody;
  def.position = ToBox2d(X_WL.p_m);
  def.gravityScale = 0;  // the arm carries the hand's own weight
  def.allowSleep = false;
  const Part part{world.CreateBody(&def), {Eigen::Vector3d::Zero(), X_WL.q}};
  const Box box{size_m};
  // A hand does not touch itself: its parts share a negative group.
  AddSection(box, part.X_PL,
             {model_.friction, 0, -1 - index_.number(), {{.hand = index_, .link = link}, 0}},
             *part.body, table);
  const double moment = inertia_scale * MomentAboutY(box, part.X_PL, mass_kg);
  const b2MassData mass{
      static_cast<float>(mass_kg), {0, 0}, static_cast<float>(moment * kTorqueScale)};
  part.body->SetMassData(&mass);
  return part;
}

Box2dHand::Motor Box2dHand::MakeMotor(const HandLink& link, const Eigen::Vector3d& axis_W,
                                      const Eigen::Vector3d& pivot_W_m, double start,
                                      b2Body& parent, b2Body& body) {
  b2World& world = *body.GetWorld();
  if (link.slides) {
    b2PrismaticJointDef def;
    def.Initialize(&parent, &body, ToBox2d(pivot_W_m), DirectionToBox2d(axis_W));
    def.enableLimit = true;
    SetLimits(link.lower - start, link.upper - start, kLengthScale, def.lowerTranslation,
              def.upperTranslation);
    def.enableMotor = true;
    return {1, start, static_cast<b2PrismaticJoint*>(world.CreateJoint(&def)), nullptr};
  }
  const double sign = axis_W.y() > 0 ? -1 : 1;
  b2RevoluteJointDef def;
  def.Initialize(&parent, &body, ToBox2d(pivot_W_m));
  def.enableLimit = true;
  SetLimits(link.lower - start, link.upper - start, sign, def.lowerAngle, def.upperAngle);
  def.enableMotor = true;
  return {sign, start, nullptr, static_cast<b2RevoluteJoint*>(world.CreateJoint(&def))};
}

double Box2dHand::Joint(const Motor& motor) const {
  return motor.start + motor.sign * (motor.slide ? motor.slide->GetJointTranslation() / kLengthScale
                                                 : motor.hinge->GetJointAngle());
}

void Box2dHand::Drive(const HandCommand& command, double dt_s) {
  command_ = command;
  const Wrench wrench = pids_.Output(StateOf(*palm_.body, palm_.X_PL), command.target, dt_s);
  palm_.body->ApplyForceToCenter(ToBox2d(wrench.force_n), true);
  palm_.body->ApplyTorque(static_cast<float>(-wrench.torque_nm.y() * kTorqueScale), true);

  const GraspStyle& style = model_.styles[static_cast<std::size_t>(command.style)];
  std::vector<double> joints;
  for (const Motor& motor : motors_) joints.push_back(Joint(motor));
  const std::vector<double>& targets = grip_.Targets(model_, style, command.target.trigger, joints);
  const double ticks = std::min(dt_s * JointDriver::kStiffnessRate_hz, 1.0);
  for (std::size_t i = 0; i < motors_.size(); ++i)
    Drive(motors_[i], WantedSpeed(model_.driver, model_.links[i], targets[i], joints[i], dt_s),
          model_.driver.damping * ticks, model_.links[i].strength * style.effort[i]);
}

void Box2dHand::Drive(const Motor& motor, double wanted_speed, double damping, double strength) {
  const auto drive = [&](auto& joint, double speed_scale) {
    // Box2D's motors enforce their speed at once; a softer driver asks for a share of the change.
    const double now = joint.GetJointSpeed(), wanted = motor.sign * wanted_speed * speed_scale;
    joint.SetMotorSpeed(static_cast<float>(now + damping * (wanted - now)));
  };
  if (motor.slide) {
    drive(*motor.slide, kLengthScale);
    motor.slide->SetMaxMotorForce(static_cast<float>(strength * kLengthScale));
  } else {
    drive(*motor.hinge, 1);
    motor.hinge->SetMaxMotorTorque(static_cast<float>(strength * kTorqueScale));
  }
}

void Box2dHand::Describe(HandState& state) const {
  state.palm = StateOf(*palm_.body, palm_.X_PL);
  state.X_WL.resize(links_.size());
  state.joints.resize(links_.size());
  for (std::size_t i = 0; i < links_.size(); ++i) {
    state.X_WL[i] = PoseOf(*links_[i].body) * links_[i].X_PL;
    state.joints[i] = Joint(motors_[i]);
  }
  state.X_WTarget = command_.target.X_WH;
  state.trigger = command_.target.trigger;
  state.style = command_.style;
}

}  // namespace prehend::physics
