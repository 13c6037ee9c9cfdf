// SPDX-License-Identifier: Apache-2.0
// Bullet's own solver is the reference. The same scene without friction, solved by both, stays the
// same: rigid bodies to the last bit, hands, whose inertia is computed in another way, to rounding.
// Friction differs: tests/physics/bullet/friction_circle_test.cc
#include "physics/bullet/core/solver.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace prehend::physics {
namespace {

/// Bullet's own solver, with its contacts in the order in which the scene was built.
class BulletsSolver final : public btMultiBodyConstraintSolver {
 protected:
  void convertContacts(btPersistentManifold** manifolds, int count,
                       const btContactSolverInfo& info) override {
    PlaceInOrder(manifolds, count);
    btMultiBodyConstraintSolver::convertContacts(manifolds, count, info);
  }
};

/// A palm with two fingers comes down on a ball that spins without friction, and closes.
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
    hand_.addBaseForce({0.02, 0.01, 4});
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
    ball_->setFriction(0);
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
      collider->setFriction(0);
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

/// A drawer with a spring that hits its stop, boxes that begin inside each other, one that stays in
/// a plane, one that is moved by nobody knows whom, a ball that bounces; all without friction.
class HeapOfThings {
 public:
  explicit HeapOfThings(btMultiBodyConstraintSolver& solver)
      : world_(&dispatcher_, &broadphase_, &solver, &configuration_) {
    world_.setGravity({0, 0, -9.81});
    btContactSolverInfo& info = world_.getSolverInfo();
    info.m_numIterations = 50;
    info.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
    info.m_splitImpulse = true;
    info.m_splitImpulsePenetrationThreshold = -0.001;
    Add(floor_shape_, 0, {0, 0, -0.5});
    // None is five times as heavy as another one: rows of such are solved more often
    // (FindRepeats()).
    for (int i = 0; i < 5; ++i)
      Add(box_shape_, 1 + 0.5 * i, {0.01 * i, 0.004 * i, 0.048 + 0.09 * i});
    bodies_.back()->setLinearFactor({1, 0, 1});
    bodies_.back()->setAngularFactor({0, 1, 0});
    btRigidBody& ball = Add(ball_shape_, 0.3, {0.3, 0, 0.2});
    ball.setRestitution(0.7);
    ball.setAngularVelocity({3, 1, 5});
    btRigidBody& pusher = Add(box_shape_, 0, {-0.2, 0, 0.06});
    pusher.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    pusher.setActivationState(DISABLE_DEACTIVATION);
    AddDrawer();
  }

  ~HeapOfThings() {
    world_.removeConstraint(slider_.get());
    for (auto& body : bodies_) world_.removeRigidBody(body.get());
  }

  void Step() {
    btRigidBody& pusher = *bodies_[7];
    btTransform place = pusher.getWorldTransform();
    pusher.setInterpolationWorldTransform(place);
    place.setOrigin(place.getOrigin() + btVector3(0.0005, 0, 0));
    pusher.setWorldTransform(place);
    pusher.setLinearVelocity({0.24, 0, 0});
    world_.stepSimulation(1.0 / 480, 0);
    for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
      const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(i);
      for (int point = 0; point < manifold.getNumContacts(); ++point)
        deepest_ = std::min(deepest_, manifold.getContactPoint(point).getDistance());
    }
  }

  btScalar deepest() const { return deepest_; }  ///< contact of all steps, m; negative: within

  std::vector<btScalar> State() const {
    std::vector<btScalar> state;
    for (const auto& body : bodies_) {
      for (const btVector3& v : {body->getWorldTransform().getOrigin(), body->getLinearVelocity(),
                                 body->getAngularVelocity()})
        state.insert(state.end(), {v.x(), v.y(), v.z()});
    }
    state.push_back(slider_->getAppliedImpulse());
    return state;
  }

 private:
  btRigidBody& Add(btCollisionShape& shape, btScalar mass_kg, const btVector3& at) {
    btVector3 inertia(0, 0, 0);
    if (mass_kg > 0) shape.calculateLocalInertia(mass_kg, inertia);
    auto& body =
        bodies_.emplace_back(std::make_unique<btRigidBody>(mass_kg, nullptr, &shape, inertia));
    body->setWorldTransform(btTransform(btQuaternion::getIdentity(), at));
    body->setFriction(0);
    world_.addRigidBody(body.get());
    return *body;
  }

  void AddDrawer() {
    btRigidBody& drawer = Add(box_shape_, 2, {0, 0.5, 0.2});
    slider_ = std::make_unique<btGeneric6DofSpring2Constraint>(drawer, btTransform::getIdentity());
    slider_->setLinearLowerLimit({0, 0, 0});
    slider_->setLinearUpperLimit({0.3, 0, 0});
    slider_->setAngularLowerLimit({0, 0, 0});
    slider_->setAngularUpperLimit({0, 0, 0});
    slider_->enableSpring(0, true);
    slider_->setStiffness(0, 30);
    slider_->setEquilibriumPoint(0, 0);
    drawer.setLinearVelocity({2.5, 0, 0});
    world_.addConstraint(slider_.get());
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btMultiBodyDynamicsWorld world_;
  btBoxShape floor_shape_{{2, 2, 0.5}}, box_shape_{{0.05, 0.05, 0.05}};
  btSphereShape ball_shape_{0.04};
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::unique_ptr<btGeneric6DofSpring2Constraint> slider_;
  btScalar deepest_ = 0;
};

constexpr int kSteps = 480;  ///< a second

TEST(BulletSolver, GivesBulletsOwnResultsForRigidBodies) {
  BulletSolver ours;
  BulletsSolver bullets;
  HeapOfThings a(ours), b(bullets);
  for (int step = 0; step < kSteps; ++step) {
    a.Step();
    b.Step();
    ASSERT_EQ(a.State(), b.State()) << "step " << step;
  }
  EXPECT_LT(a.deepest(), -0.002) << "nothing was pushed out";
}

TEST(BulletSolver, GivesBulletsOwnResultsForHands) {
  BulletSolver ours;
  BulletsSolver bullets;
  GripOnABall a(ours), b(bullets);
  for (int step = 0; step < kSteps; ++step) {
    a.Step();
    b.Step();
    const std::vector<btScalar> of_a = a.State(), of_b = b.State();
    for (std::size_t i = 0; i < of_a.size(); ++i)
      ASSERT_NEAR(of_a[i], of_b[i], 1e-9) << "element " << i << ", step " << step;
  }
  EXPECT_GT(a.touched(), 100) << "the hand hardly touched the ball";
  EXPECT_EQ(a.touched(), b.touched());
}

}  // namespace
}  // namespace prehend::physics
