// SPDX-License-Identifier: Apache-2.0
// Bullet's world with loops that skip sleeping bodies. Bullet visits all bodies some eight times
// per tick and predicts their motion. Only for physics/bullet. Tested by
// tests/physics/world/world_test.cc
#pragma once

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <vector>

#include "physics/bullet/core/grain_contacts.h"
#include "physics/bullet/core/swept_motion.h"

namespace prehend::physics {

/// All bodies must be added before the first step.
class BulletDynamics final : public btMultiBodyDynamicsWorld {
 public:
  BulletDynamics(btDispatcher& dispatcher, btDbvtBroadphase& broadphase,
                 btMultiBodyConstraintSolver& solver, btCollisionConfiguration& configuration,
                 GrainContacts& grains);

  /// Also finds the contacts between grains.
  void performDiscreteCollisionDetection() override;
  void updateAabbs() override;
  /// Damps bodies. Without Bullet's two predictions of where they will be, which only continuous
  /// collision detection reads: it is off.
  void predictUnconstraintMotion(btScalar dt_s) override;
  void createPredictiveContacts(btScalar) override {}
  /// Whether a body was awake in the last step. If not, it was skipped as a whole.
  bool any_awake() const { return any_awake_; }
  /// Whether the last step woke a body.
  bool woke_any() const { return woke_any_; }

 private:
  void internalSingleStepSimulation(btScalar dt_s) override;
  void solveConstraints(btContactSolverInfo& info) override;
  /// Bodies stop where they would go through others.
  void integrateTransforms(btScalar dt_s) override;
  /// Bullet enlarges the boxes of moving bodies by 20 mm: every grain would be paired with the
  /// whole vessel.
  void SetTightBox(btCollisionObject& object);

  GrainContacts& grains_;
  GrainFilter filter_;
  SweptMotion swept_{*this};
  std::vector<btRigidBody*> moving_;  ///< all bodies that are not static, in order of insertion
  std::vector<char> stepped_;         ///< by index in moving_: in Bullet's list of this step
  bool any_awake_ = false;
  bool woke_any_ = false;
};

}  // namespace prehend::physics
