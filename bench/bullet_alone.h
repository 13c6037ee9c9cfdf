// SPDX-License-Identifier: Apache-2.0
// The yardstick of bench/physics_bench.cc: boxes on a floor in a bare Bullet loop, with the same
// settings of solver, sleeping and broad phase as physics/bullet/world.cc, and nothing read back.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <vector>

#include "physics/scene/scene.h"

extern btScalar gDbvtMargin;

namespace prehend::bench {

class BulletAlone {
 public:
  /// `scene`: bodies of one box each, no joints, no hands.
  explicit BulletAlone(const physics::Scene& scene) : dt_s_(1.0 / scene.world.rate_hz) {
    gDbvtMargin = 0.002;
    world_.setGravity({0, 0, -scene.world.gravity_m_per_s2});
    world_.setForceUpdateAllAabbs(false);
    world_.getDispatchInfo().m_deterministicOverlappingPairs = true;
    world_.getDispatchInfo().m_useContinuous = false;
    btContactSolverInfo& info = world_.getSolverInfo();
    info.m_numIterations = 50;
    info.m_splitImpulsePenetrationThreshold = -0.0005;
    info.m_minimumSolverBatchSize = 2;
    info.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
    for (const physics::Body& body : scene.bodies) Add(body);
  }
  ~BulletAlone() {
    for (auto& body : bodies_) world_.removeRigidBody(body.get());
  }

  void Step() { world_.stepSimulation(dt_s_, 0); }

 private:
  void Add(const physics::Body& body) {
    const Eigen::Vector3d half = std::get<physics::Box>(body.shapes.front().shape).size_m / 2;
    const Eigen::Vector3d& p = body.X_WB.p_m;
    auto& shape =
        shapes_.emplace_back(std::make_unique<btBoxShape>(btVector3(half.x(), half.y(), half.z())));
    shape->setMargin(0.001);
    const double mass = body.fixed ? 0 : body.mass_kg;
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape.get(), inertia);
    info.m_startWorldTransform.setIdentity();
    info.m_startWorldTransform.setOrigin({p.x(), p.y(), p.z()});
    info.m_friction = body.friction;
    info.m_linearSleepingThreshold = 0.01;
    info.m_angularSleepingThreshold = 0.05;
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    world_.addRigidBody(bodies_.back().get());
  }

  const double dt_s_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

}  // namespace prehend::bench
