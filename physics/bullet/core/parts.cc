// SPDX-License-Identifier: Apache-2.0
#include "physics/bullet/core/parts.h"

#include <btBulletDynamicsCommon.h>

#include "physics/bullet/core/dispatcher.h"
#include "physics/bullet/core/dynamics_world.h"
#include "physics/bullet/core/flat_impacts.h"
#include "physics/bullet/core/solver.h"

static_assert(BT_BULLET_VERSION == 324,
              "physics/bullet/core/ replaces parts of Bullet 3.24. With another version: compare "
              "each part with the new source of the class that it derives from, run the tests of "
              "physics/ and the pinned hashes, renew the figures in physics/bullet/core/README.md, "
              "then change this number.");
static_assert(sizeof(btScalar) == sizeof(double), "link Bullet's double-precision build");

namespace prehend::physics {
namespace {

class ReplacedParts final : public BulletEngine {
 public:
  btMultiBodyDynamicsWorld& world() override { return world_; }
  btMultiBodyConstraintSolver& solver() override { return solver_; }
  const btManifoldArray& ChangedManifolds() override {
    if (!world_.any_awake()) return none_;
    // A body that is woken in a step keeps the contacts that it had when it fell asleep.
    return world_.woke_any() ? dispatcher_.AllManifolds() : dispatcher_.AwakeManifolds();
  }

 private:
  ImpactConfiguration configuration_;
  BulletDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  GrainContacts grains_;
  BulletSolver solver_{grains_};
  BulletDynamics world_{dispatcher_, broadphase_, solver_, configuration_, grains_};
  const btManifoldArray none_;
};

class StockParts final : public BulletEngine {
 public:
  btMultiBodyDynamicsWorld& world() override { return world_; }
  btMultiBodyConstraintSolver& solver() override { return solver_; }
  const btManifoldArray& ChangedManifolds() override {
    manifolds_.resize(0);
    for (int i = 0; i < dispatcher_.getNumManifolds(); ++i)
      manifolds_.push_back(dispatcher_.getManifoldByIndexInternal(i));
    return manifolds_;
  }

 private:
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btMultiBodyConstraintSolver solver_;
  btMultiBodyDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  btManifoldArray manifolds_;
};

}  // namespace

std::unique_ptr<BulletEngine> MakeBulletEngine(BulletParts parts) {
  if (parts == BulletParts::kStock) return std::make_unique<StockParts>();
  return std::make_unique<ReplacedParts>();
}

}  // namespace prehend::physics
