// SPDX-License-Identifier: Apache-2.0
// Assembles a Bullet world: with our replacements of some of its parts, or with stock parts only.
// physics/bullet/core/README.md says what each replacement is for and what was measured. Only for
// physics/bullet. Tested by tests/physics/bullet/stock_bullet_test.cc
#pragma once

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <memory>

namespace prehend::physics {

enum class BulletParts { kReplaced, kStock };

/// An empty world with its solver, and the contacts of its last step.
class BulletEngine {
 public:
  virtual ~BulletEngine() = default;

  virtual btMultiBodyDynamicsWorld& world() = 0;
  virtual btMultiBodyConstraintSolver& solver() = 0;
  /// Contact manifolds that the last step may have changed; valid until the next step.
  virtual const btManifoldArray& ChangedManifolds() = 0;
};

std::unique_ptr<BulletEngine> MakeBulletEngine(BulletParts parts);

}  // namespace prehend::physics
