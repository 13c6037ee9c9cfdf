// SPDX-License-Identifier: Apache-2.0
// Palm, links, joint motors and joint limits as one btMultiBody.
#include "physics/bullet/hand.h"

#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>

#include <algorithm>

#include "physics/bullet/body.h"

namespace prehend::physics {
namespace {

/// Frame of a link's centre in H with all joints at zero, as in forward kinematics.
std::vector<Pose> RestPoses(const HandModel& model) {
  return LinkPoses(model, std::vector<double>(model.links.size(), 0.0));
}

std::unique_ptr<btCollisionShape> LinkShape(const HandLink& link) {
  return MakeShape(Box{{link.length_m, 2 * link.half_width_m, 2 * link.half_thickness_m}});
}

}  // namespace

BulletHand::BulletHand(const Hand& hand, int style, int group, btMultiBodyDynamicsWorld& world)
    : model_(hand.model),
      places_(hand.model),
      world_(world),
      pids_(hand.model),
      command_{.target = {.X_WH = hand.X_WH}, .style = style} {
  MakeLinks();
  multibody_->setBaseWorldTransform(ToBullet(hand.X_WH));
  world_.addMultiBody(multibody_.get());
  MakeCollider(-1, MakeShape(Box{model_.palm_size_m}), group);
  for (std::size_t i = 0; i < model_.links.size(); ++i)
    MakeCollider(static_cast<int>(i), LinkShape(model_.links[i]), group);
  MakeMotors();
  SetJoints(JointTargets(model_.styles[static_cast<std::size_t>(style)], 0));
}

BulletHand::~BulletHand() {
  for (auto& motor : motors_) world_.removeMultiBodyConstraint(motor.get());
  for (auto& limit : limits_) world_.removeMultiBodyConstraint(limit.get());
  for (auto& collider : colliders_) world_.removeCollisionObject(collider.get());
  world_.removeMultiBody(multibody_.get());
}

void BulletHand::MakeLinks() {
  btVector3 inertia;
  MakeShape(Box{model_.palm_size_m})->calculateLocalInertia(model_.palm_mass_kg, inertia);
  inertia *= model_.palm_inertia_scale;
  const int count = static_cast<int>(model_.links.size());
  multibody_ = std::make_unique<btMultiBody>(count, model_.palm_mass_kg, inertia, false, false);
  multibody_->setHasSelfCollision(false);
  multibody_->setLinearDamping(0);
  multibody_->setAngularDamping(0);
  multibody_->setUseGyroTerm(true);
  multibody_->setCanSleep(false);

  const std::vector<Pose> rest = RestPoses(model_);
  for (int i = 0; i < count; ++i) {
    const HandLink& link = model_.link(LinkIndex(i));
    const Pose& X_HL = rest[static_cast<std::size_t>(i)];
    const Pose X_HP = link.parent == kNone ? Pose{} : At(rest, link.parent);
    LinkShape(link)->calculateLocalInertia(link.mass_kg, inertia);
    const btQuaternion turn = ToBullet(Eigen::Quaterniond(X_HL.q.conjugate() * X_HP.q));
    const btVector3 axis = ToBullet(Eigen::Vector3d(X_HL.q.conjugate() * link.joint_axis));
    const btVector3 pivot =
        ToBullet(Eigen::Vector3d(X_HP.q.conjugate() * (link.pivot_m - X_HP.p_m)));
    const btVector3 centre =
        ToBullet(Eigen::Vector3d(X_HL.q.conjugate() * (X_HL.p_m - link.pivot_m)));
    if (link.slides)
      multibody_->setupPrismatic(i, link.mass_kg, inertia, link.parent.number(), turn, axis, pivot,
                                 centre, true);
    else
      multibody_->setupRevolute(i, link.mass_kg, inertia, link.parent.number(), turn, axis, pivot,
                                centre, true);
  }
  multibody_->finalizeMultiDof();
}

void BulletHand::MakeCollider(int link, std::unique_ptr<btCollisionShape> shape, int group) {
  auto collider = std::make_unique<btMultiBodyLinkCollider>(multibody_.get(), link);
  collider->setCollisionShape(shape.get());
  collider->setFriction(model_.friction);
  collider->setRollingFriction(0);
  collider->setSpinningFriction(model_.spinning_friction);
  collider->setActivationState(DISABLE_DEACTIVATION);
  world_.addCollisionObject(collider.get(), group, ~group);
  if (link < 0)
    multibody_->setBaseCollider(collider.get());
  else
    multibody_->getLink(link).m_collider = collider.get();
  shapes_.push_back(std::move(shape));
  colliders_.push_back(std::move(collider));
}

void BulletHand::MakeMotors() {
  for (std::size_t i = 0; i < model_.links.size(); ++i) {
    const HandLink& link = model_.links[i];
    const int index = static_cast<int>(i);
    motors_.push_back(std::make_unique<btMultiBodyJointMotor>(multibody_.get(), index, 0, 0, 0));
    limits_.push_back(std::make_unique<btMultiBodyJointLimitConstraint>(multibody_.get(), index,
                                                                        link.lower, link.upper));
    world_.addMultiBodyConstraint(motors_.back().get());
    world_.addMultiBodyConstraint(limits_.back().get());
  }
}

void BulletHand::SetJoints(const std::vector<double>& joints) {
  for (std::size_t i = 0; i < joints.size(); ++i)
    multibody_->setJointPos(static_cast<int>(i), joints[i]);
  btAlignedObjectArray<btQuaternion> rotations;
  btAlignedObjectArray<btVector3> origins;
  multibody_->forwardKinematics(rotations, origins);
  multibody_->updateCollisionObjectWorldTransforms(rotations, origins);
  for (auto& collider : colliders_) world_.updateSingleAabb(collider.get());
}

void BulletHand::Drive(const HandCommand& command, double dt_s, double gravity_m_per_s2) {
  command_ = command;
  DrivePalm(command, dt_s, gravity_m_per_s2);
  DriveJoints(model_.styles[static_cast<std::size_t>(command.style)], command.target.trigger, dt_s);
}

void BulletHand::DrivePalm(const HandCommand& command, double dt_s, double gravity_m_per_s2) {
  const Wrench wrench = pids_.Output(PalmState(), command.target, dt_s, bool(command.lets_go_to));
  // The arm carries the hand's own weight, so that the PIDs feel only what the hand holds.
  const Eigen::Vector3d up(0, 0, gravity_m_per_s2);
  multibody_->addBaseForce(ToBullet(Eigen::Vector3d(wrench.force_n + up * model_.palm_mass_kg)));
  multibody_->addBaseTorque(ToBullet(wrench.torque_nm));
  for (std::size_t i = 0; i < model_.links.size(); ++i)
    multibody_->addLinkForce(static_cast<int>(i),
                             ToBullet(Eigen::Vector3d(up * model_.links[i].mass_kg)));
}

void BulletHand::DriveJoints(const GraspStyle& style, double trigger, double dt_s) {
  const JointDriver& driver = model_.driver;
  std::vector<double> joints;
  for (std::size_t i = 0; i < motors_.size(); ++i)
    joints.push_back(multibody_->getJointPos(static_cast<int>(i)));
  const std::vector<double>& targets =
      grip_.Targets(model_, style, trigger, joints, command_.lets_go_to.value_or(1));
  const double damping = driver.damping * std::min(dt_s * JointDriver::kStiffnessRate_hz, 1.0);
  for (std::size_t i = 0; i < targets.size(); ++i) {
    motors_[i]->setPositionTarget(0, 0);
    motors_[i]->setVelocityTarget(WantedSpeed(driver, model_.links[i], targets[i], joints[i], dt_s),
                                  damping);
    motors_[i]->setMaxAppliedImpulse(model_.links[i].strength * style.effort[i] * dt_s);
  }
}

BodyState BulletHand::PalmState() const {
  return {.X_WB = FromBullet(multibody_->getBaseWorldTransform()),
          .v_WB_m_per_s = FromBullet(multibody_->getBaseVel()),
          .w_WB_rad_per_s = FromBullet(multibody_->getBaseOmega())};
}

void BulletHand::Describe(HandState& state) const {
  state.palm = PalmState();
  state.joints.resize(model_.links.size());
  for (std::size_t i = 0; i < model_.links.size(); ++i)
    state.joints[i] = multibody_->getJointPos(static_cast<int>(i));
  places_.Place(state.palm.X_WB, state.joints, state.X_WL);
  state.X_WTarget = command_.target.X_WH;
  state.trigger = command_.target.trigger;
  state.style = command_.style;
}

}  // namespace prehend::physics
