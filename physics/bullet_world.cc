// SPDX-License-Identifier: Apache-2.0
// Needs: Bullet 3.24 built with double precision. Order matters for determinism: bodies first, then
// hands, in scene order; one step of dt per tick, never Bullet's own sub-stepping, whose remainder
// can drop time. Tested by tests/physics/world_test.cc
#include "physics/bullet_world.h"

#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include "physics/bullet_body.h"
#include "physics/bullet_contacts.h"
#include "physics/bullet_convert.h"
#include "physics/bullet_hand.h"

// The only process-wide setting of Bullet that is touched. Every world sets the same constant.
extern btScalar gDbvtMargin;

namespace prehend::physics {
namespace {

/// Growth of boxes in the broad phase, metres. Bullet's 50 mm joins neighbours into one island: ten
/// times slower.
constexpr double kBroadphaseMargin_m = 0.002;
/// Fewer lose friction grasps: 20 iterations placed 28 of 40 objects.
constexpr int kSolverIterations = 50;
constexpr double kErrorReduction = 0.2;
/// Deeper penetration than this is pushed out without adding velocity.
constexpr double kSplitImpulseThreshold_m = -0.0005;
/// Slower impacts do not bounce.
constexpr double kRestitutionThreshold_m_per_s = 0.2;
/// Islands are solved one by one, not merged into batches: a sleeping neighbour must not change a
/// result.
constexpr int kSolverBatch = 2;

// Collision groups. Fixed bodies need no contacts with each other; every hand has its own bit from
// kFirstHandGroup.
constexpr int kFixedGroup = 1;
constexpr int kMovingGroup = 2;
constexpr int kFirstHandGroup = 4;

class BulletWorld final : public World {
 public:
  BulletWorld(const Scene& scene, const std::vector<int>& styles);
  ~BulletWorld() override;

  void Step(const std::vector<HandCommand>& commands) override;
  void Describe(Snapshot& snapshot) const override;

 private:
  void Configure();
  void AddBodies(const std::vector<Body>& bodies);
  void AddHands(const std::vector<Hand>& hands, const std::vector<int>& styles);

  const double dt_s_;
  const double gravity_m_per_s2_;
  std::int64_t tick_ = 0;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btMultiBodyConstraintSolver solver_;
  btMultiBodyDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<BulletBody>> bodies_;
  std::vector<std::unique_ptr<BulletHand>> hands_;
  ContactSides sides_;
  BulletContacts contacts_{{}};
};

BulletWorld::BulletWorld(const Scene& scene, const std::vector<int>& styles)
    : dt_s_(1.0 / scene.world.rate_hz), gravity_m_per_s2_(scene.world.gravity_m_per_s2) {
  Configure();
  AddBodies(scene.bodies);
  AddHands(scene.hands, styles);
  contacts_ = BulletContacts(sides_);
}

BulletWorld::~BulletWorld() {
  hands_.clear();
  for (auto& body : bodies_) world_.removeRigidBody(&body->rigid());
}

void BulletWorld::Configure() {
  gDbvtMargin = kBroadphaseMargin_m;
  world_.setGravity({0, 0, -gravity_m_per_s2_});
  world_.setForceUpdateAllAabbs(false);
  world_.setLatencyMotionStateInterpolation(false);
  world_.getDispatchInfo().m_deterministicOverlappingPairs = true;
  world_.getDispatchInfo().m_useContinuous = false;
  solver_.setRandSeed(0);
  btContactSolverInfo& info = world_.getSolverInfo();
  info.m_numIterations = kSolverIterations;
  info.m_erp = kErrorReduction;
  info.m_erp2 = kErrorReduction;
  info.m_splitImpulse = true;
  info.m_splitImpulsePenetrationThreshold = kSplitImpulseThreshold_m;
  info.m_restitutionVelocityThreshold = kRestitutionThreshold_m_per_s;
  info.m_minimumSolverBatchSize = kSolverBatch;
  info.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
  info.m_solverMode &= ~SOLVER_RANDMIZE_ORDER;
}

void BulletWorld::AddBodies(const std::vector<Body>& bodies) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    auto body = std::make_unique<BulletBody>(bodies[i]);
    body->rigid().setUserIndex(static_cast<int>(sides_.size()));
    sides_.push_back({.body = static_cast<int>(i)});
    if (bodies[i].fixed)
      world_.addRigidBody(&body->rigid(), kFixedGroup, ~kFixedGroup);
    else
      world_.addRigidBody(&body->rigid(), kMovingGroup, -1);
    bodies_.push_back(std::move(body));
  }
}

void BulletWorld::AddHands(const std::vector<Hand>& hands, const std::vector<int>& styles) {
  for (std::size_t i = 0; i < hands.size(); ++i) {
    auto hand = std::make_unique<BulletHand>(hands[i], styles[i], kFirstHandGroup << i, world_);
    for (auto& collider : hand->colliders()) {
      collider->setUserIndex(static_cast<int>(sides_.size()));
      sides_.push_back({.hand = static_cast<int>(i), .link = collider->m_link});
    }
    hands_.push_back(std::move(hand));
  }
}

void BulletWorld::Step(const std::vector<HandCommand>& commands) {
  for (std::size_t i = 0; i < hands_.size(); ++i)
    hands_[i]->Drive(commands[i], dt_s_, gravity_m_per_s2_);
  world_.stepSimulation(dt_s_, 0);
  contacts_.Read(dispatcher_);
  ++tick_;
}

void BulletWorld::Describe(Snapshot& snapshot) const {
  snapshot.tick = tick_;
  snapshot.bodies.resize(bodies_.size());
  for (std::size_t i = 0; i < bodies_.size(); ++i) snapshot.bodies[i] = bodies_[i]->State();
  snapshot.hands.resize(hands_.size());
  for (std::size_t i = 0; i < hands_.size(); ++i) hands_[i]->Describe(snapshot.hands[i]);
  contacts_.Describe(snapshot.contacts);
}

}  // namespace

std::unique_ptr<World> MakeBulletWorld(const Scene& scene, const std::vector<int>& styles) {
  return std::make_unique<BulletWorld>(scene, styles);
}

}  // namespace prehend::physics
