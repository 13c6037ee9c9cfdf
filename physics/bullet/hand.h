// SPDX-License-Identifier: Apache-2.0
// An articulated hand in Bullet: Featherstone multi-body, two 6D PIDs on the palm, a torque-limited
// velocity servo per joint. It holds things by friction only; nothing ever ties an object to it.
// Only for physics/bullet. Tested by tests/physics/world/world_test.cc
#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <memory>
#include <vector>

#include "physics/hand/grip.h"
#include "physics/hand/pid.h"
#include "physics/scene/hand_model.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"
#include "physics/world/world.h"

namespace prehend::physics {

class BulletHand {
 public:
  /// `group`: this hand's collision bit; the hand does not collide with itself. The hand starts
  /// open in `style`.
  BulletHand(const Hand& hand, int style, int group, btMultiBodyDynamicsWorld& world);
  ~BulletHand();
  BulletHand(const BulletHand&) = delete;
  BulletHand& operator=(const BulletHand&) = delete;

  /// Sets forces and motor targets for the coming tick.
  void Drive(const HandCommand& command, double dt_s, double gravity_m_per_s2);
  void Describe(HandState& state) const;

  /// Link index of one of this hand's colliders, -1 for the palm; in the order they were made.
  const std::vector<std::unique_ptr<btMultiBodyLinkCollider>>& colliders() const {
    return colliders_;
  }

 private:
  void MakeLinks();
  void MakeCollider(int link, std::unique_ptr<btCollisionShape> shape, int group);
  void MakeMotors();
  void SetJoints(const std::vector<double>& joints);
  void DrivePalm(const HandCommand& command, double dt_s, double gravity_m_per_s2);
  BodyState PalmState() const;
  void DriveJoints(const GraspStyle& style, double trigger, double dt_s);

  HandModel model_;
  LinkPlaces places_;
  btMultiBodyDynamicsWorld& world_;
  std::unique_ptr<btMultiBody> multibody_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;  ///< palm first, then the links
  std::vector<std::unique_ptr<btMultiBodyJointMotor>> motors_;
  std::vector<std::unique_ptr<btMultiBodyConstraint>> limits_;
  PalmPids pids_;
  Grip grip_;
  HandCommand command_;
};

}  // namespace prehend::physics
