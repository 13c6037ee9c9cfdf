// SPDX-License-Identifier: Apache-2.0
// Bullet's own solver is the witness: the same scene, solved by both, stays the same to the last
// bit.
#include "physics/bullet_solver.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace prehend::physics {
namespace {

/// A palm with two fingers comes down on a ball that rolls and spins with friction, and closes.
class GripOnABall {
 public:
  explicit GripOnABall(btMultiBodyConstraintSolver& solver)
      : world_(&dispatcher_, &broadphase_, &solver, &configuration_) {
    world_.setGravity({0, 0, -9.81});
    world_.getSolverInfo().m_numIterations = 50;
    world_.getSolverInfo().m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
    AddFloorAndBall();
    AddHand();
  }

  ~GripOnABall() {
    for (auto& constraint : constraints_) world_.removeMultiBodyConstraint(constraint.get());
    for (auto& collider : colliders_) world_.removeCollisionObject(collider.get());
    world_.removeMultiBody(&hand_);
    world_.removeRigidBody(ball_.get());
    world_.removeRigidBody(floor_.get());
  }

  void Step() {
    hand_.addBaseForce({2, 1, 4});
    world_.stepSimulation(1.0 / 480, 0);
    for (int i = 0; i < dispatcher_.getNumManifolds(); ++i)
      for (const auto& collider : colliders_)
        if (dispatcher_.getManifoldByIndexInternal(i)->getBody0() == collider.get() ||
            dispatcher_.getManifoldByIndexInternal(i)->getBody1() == collider.get())
          touched_ += dispatcher_.getManifoldByIndexInternal(i)->getNumContacts();
  }

  /// Contacts of the hand, summed over all steps.
  int touched() const { return touched_; }

  std::vector<btScalar> State() const {
    std::vector<btScalar> state;
    const auto add = [&](const btVector3& v) { state.insert(state.end(), {v.x(), v.y(), v.z()}); };
    add(ball_->getWorldTransform().getOrigin());
    add(ball_->getLinearVelocity());
    add(ball_->getAngularVelocity());
    add(hand_.getBasePos());
    add(hand_.getBaseVel());
    add(hand_.getBaseOmega());
    for (int i = 0; i < hand_.getNumLinks(); ++i) {
      state.push_back(hand_.getJointPos(i));
      state.push_back(hand_.getJointVel(i));
    }
    return state;
  }

 private:
  void AddFloorAndBall() {
    floor_ = std::make_unique<btRigidBody>(0, nullptr, &floor_shape_);
    floor_->setWorldTransform(btTransform(btQuaternion::getIdentity(), {0, 0, -0.5}));
    btVector3 inertia;
    ball_shape_.calculateLocalInertia(0.3, inertia);
    ball_ = std::make_unique<btRigidBody>(0.3, nullptr, &ball_shape_, inertia);
    ball_->setWorldTransform(btTransform(btQuaternion::getIdentity(), {0.005, 0.003, 0.04}));
    ball_->setRollingFriction(0.01);
    ball_->setSpinningFriction(0.01);
    ball_->setAngularVelocity({0.2, 3, 5});
    world_.addRigidBody(floor_.get());
    world_.addRigidBody(ball_.get());
  }

  void AddHand() {
    const btVector3 inertia(1e-3, 1e-3, 1e-3);
    for (int i = 0; i < 2; ++i) {
      const btScalar side = i == 0 ? 1 : -1;
      hand_.setupRevolute(i, 0.1, inertia / 10, -1, btQuaternion::getIdentity(), {0, side, 0},
                          {side * 0.05, 0, -0.01}, {0, 0, -0.04}, true);
    }
    hand_.finalizeMultiDof();
    hand_.setHasSelfCollision(false);
    hand_.setBaseWorldTransform(btTransform(btQuaternion::getIdentity(), {0, 0, 0.105}));
    world_.addMultiBody(&hand_);
    for (int link = -1; link < 2; ++link) {
      auto& collider =
          colliders_.emplace_back(std::make_unique<btMultiBodyLinkCollider>(&hand_, link));
      collider->setCollisionShape(link < 0 ? &palm_shape_ : &finger_shape_);
      collider->setRollingFriction(0.02);
      collider->setSpinningFriction(0.02);
      world_.addCollisionObject(collider.get(), 2, 1);
      if (link < 0) {
        hand_.setBaseCollider(collider.get());
      } else {
        hand_.getLink(link).m_collider = collider.get();
        constraints_.push_back(std::make_unique<btMultiBodyJointMotor>(&hand_, link, 2, 0.01));
        constraints_.push_back(
            std::make_unique<btMultiBodyJointLimitConstraint>(&hand_, link, -0.5, 0.6));
      }
    }
    for (auto& constraint : constraints_) world_.addMultiBodyConstraint(constraint.get());
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btMultiBodyDynamicsWorld world_;
  btBoxShape floor_shape_{{1, 1, 0.5}}, palm_shape_{{0.06, 0.03, 0.01}},
      finger_shape_{{0.008, 0.01, 0.035}};
  btSphereShape ball_shape_{0.04};
  std::unique_ptr<btRigidBody> floor_, ball_;
  btMultiBody hand_{2, 0.5, {1e-3, 1e-3, 1e-3}, false, false};
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
  std::vector<std::unique_ptr<btMultiBodyConstraint>> constraints_;
  int touched_ = 0;
};

TEST(BulletSolver, GivesBulletsOwnResultsToTheLastBit) {
  BulletSolver ours;
  btMultiBodyConstraintSolver bullets;
  GripOnABall a(ours), b(bullets);
  for (int step = 0; step < 480; ++step) {
    a.Step();
    b.Step();
    ASSERT_EQ(a.State(), b.State()) << "step " << step;
  }
  EXPECT_GT(a.touched(), 480) << "the hand hardly touched the ball";
  EXPECT_EQ(a.touched(), b.touched());
}

}  // namespace
}  // namespace prehend::physics
