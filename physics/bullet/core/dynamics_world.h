// SPDX-License-Identifier: Apache-2.0
// Bullet's world, whose loops over bodies leave out those that sleep. Bullet goes through all of
// them some eight times a tick, and moves where each will be. Only for bullet_*.cc. Tested by
// tests/physics/world/world_test.cc
#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <vector>

namespace prehend::physics {

/// Second user index of a body whose box in the broad phase is as large as it is. Bullet makes
/// boxes of moving bodies 20 mm larger than need be. For grains, that joins every one with all of
/// its vessel: 200 of them took 6 ms a tick, and take 2 ms with tight boxes.
constexpr int kTightBox = 1;

/// Add all bodies before the first step.
class BulletDynamics final : public btMultiBodyDynamicsWorld {
 public:
  using btMultiBodyDynamicsWorld::btMultiBodyDynamicsWorld;

  void updateAabbs() override;
  /// Whether the last step woke a body.
  bool woke_any() const { return woke_any_; }

 private:
  void internalSingleStepSimulation(btScalar dt_s) override;
  void solveConstraints(btContactSolverInfo& info) override;
  void SetTightBox(btCollisionObject& object);

  std::vector<btRigidBody*> moving_;  ///< all that are not static, in the order of their adding
  std::vector<char> stepped_;         ///< parallel: in Bullet's list of this step
  bool woke_any_ = false;
};

}  // namespace prehend::physics
