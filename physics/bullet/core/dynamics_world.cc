// SPDX-License-Identifier: Apache-2.0
// Bullet's own list of moving bodies holds only the awake ones while it steps.
#include "physics/bullet/core/dynamics_world.h"

#include <BulletCollision/CollisionDispatch/btSimulationIslandManager.h>
#include <btBulletCollisionCommon.h>

#include <new>

namespace prehend::physics {
namespace {

/// Bullet's search for islands, which grains that touch belong to as well.
class IslandsWithGrains final : public btSimulationIslandManager {
 public:
  explicit IslandsWithGrains(GrainContacts& grains) : grains_(grains) {}

  void updateActivationState(btCollisionWorld* world, btDispatcher* dispatcher) override {
    btSimulationIslandManager::updateActivationState(world, dispatcher);
    for (const GrainContact& contact : grains_.contacts())
      getUnionFind().unite(contact.a->getIslandTag(), contact.b->getIslandTag());
  }

 private:
  GrainContacts& grains_;
};

}  // namespace

BulletDynamics::BulletDynamics(btDispatcher& dispatcher, btDbvtBroadphase& broadphase,
                               btMultiBodyConstraintSolver& solver,
                               btCollisionConfiguration& configuration, GrainContacts& grains)
    : btMultiBodyDynamicsWorld(&dispatcher, &broadphase, &solver, &configuration), grains_(grains) {
  getPairCache()->setOverlapFilterCallback(&filter_);
  // Bullet made one, and destroys this one, in the same way.
  m_islandManager->~btSimulationIslandManager();
  btAlignedFree(m_islandManager);
  m_islandManager = new (btAlignedAlloc(sizeof(IslandsWithGrains), 16)) IslandsWithGrains(grains);
}

void BulletDynamics::performDiscreteCollisionDetection() {
  btMultiBodyDynamicsWorld::performDiscreteCollisionDetection();
  grains_.Find();
}

void BulletDynamics::updateAabbs() {
  for (int i = 0; i < m_collisionObjects.size(); ++i) {
    btCollisionObject& object = *m_collisionObjects[i];
    if (!object.isActive()) continue;
    if (object.getUserIndex2() == kGrain)
      SetTightBox(object);
    else
      updateSingleAabb(&object);
  }
}

void BulletDynamics::predictUnconstraintMotion(btScalar dt_s) {
  for (int i = 0; i < m_nonStaticRigidBodies.size(); ++i) {
    btRigidBody& body = *m_nonStaticRigidBodies[i];
    if (!body.isStaticOrKinematicObject()) body.applyDamping(dt_s);
  }
}

void BulletDynamics::SetTightBox(btCollisionObject& object) {
  btVector3 least, most;
  object.getCollisionShape()->getAabb(object.getWorldTransform(), least, most);
  getBroadphase()->setAabb(object.getBroadphaseHandle(), least, most, getDispatcher());
}

void BulletDynamics::internalSingleStepSimulation(btScalar dt_s) {
  if (moving_.empty())
    for (int i = 0; i < m_nonStaticRigidBodies.size(); ++i) {
      moving_.push_back(m_nonStaticRigidBodies[i]);
      grains_.Add(*m_nonStaticRigidBodies[i]);
    }
  stepped_.assign(moving_.size(), 0);
  m_nonStaticRigidBodies.resize(0);
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    if (!moving_[i]->isActive()) continue;
    stepped_[i] = 1;
    m_nonStaticRigidBodies.push_back(moving_[i]);
  }
  // Hands and persons never sleep; neither is among `moving_`.
  any_awake_ = false;
  for (int i = 0; i < m_collisionObjects.size() && !any_awake_; ++i)
    any_awake_ = m_collisionObjects[i]->isActive();
  woke_any_ = false;
  if (any_awake_) btMultiBodyDynamicsWorld::internalSingleStepSimulation(dt_s);
}

void BulletDynamics::solveConstraints(btContactSolverInfo& info) {
  btMultiBodyDynamicsWorld::solveConstraints(info);
  // Islands were woken as a whole, and a body that fell asleep with its island still has to lose
  // its speed.
  woke_any_ = false;
  m_nonStaticRigidBodies.resize(0);
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    const bool woken = !stepped_[i] && moving_[i]->isActive();
    woke_any_ |= woken;
    if (stepped_[i] || woken) m_nonStaticRigidBodies.push_back(moving_[i]);
  }
}

void BulletDynamics::integrateTransforms(btScalar dt_s) {
  swept_.Find(m_nonStaticRigidBodies, dt_s);
  btMultiBodyDynamicsWorld::integrateTransforms(dt_s);
  swept_.Hold();
}

}  // namespace prehend::physics
