// SPDX-License-Identifier: Apache-2.0
// Bullet's world with loops that skip sleeping bodies. Bullet visits all bodies some eight times
// per tick and predicts their motion. Only for physics/bullet. Tested by
// tests/physics/world/world_test.cc
#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <vector>

namespace prehend::physics {

/// Second user index of a body with a tight bounding box in the broad phase. Bullet enlarges the
/// boxes of moving bodies by 20 mm. With these boxes every grain is paired with all others of its
/// vessel: 200 grains took 6 ms per tick, and take 2 ms with tight boxes.
constexpr int kTightBox = 1;

/// All bodies must be added before the first step.
class BulletDynamics final : public btMultiBodyDynamicsWorld {
 public:
  using btMultiBodyDynamicsWorld::btMultiBodyDynamicsWorld;

  void updateAabbs() override;
  /// Without Bullet's prediction of multibodies, which only continuous collision detection reads.
  void predictUnconstraintMotion(btScalar dt_s) override;
  /// Whether the last step woke a body.
  bool woke_any() const { return woke_any_; }

 private:
  void internalSingleStepSimulation(btScalar dt_s) override;
  void solveConstraints(btContactSolverInfo& info) override;
  void SetTightBox(btCollisionObject& object);

  std::vector<btRigidBody*> moving_;  ///< all bodies that are not static, in order of insertion
  std::vector<char> stepped_;         ///< by index in moving_: in Bullet's list of this step
  bool woke_any_ = false;
};

}  // namespace prehend::physics
