// SPDX-License-Identifier: Apache-2.0
// Contacts between grains, found by cells and solved as rows of their own: against a search of all
// pairs, against closed forms, and against stock Bullet.
#include "physics/bullet/core/grain_contacts.h"

#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <set>

#include "physics/bullet/core/parts.h"
#include "physics/scene/compounds.h"
#include "physics/scene/fill_vessel.h"
#include "physics/simulation.h"

namespace prehend::physics {
namespace {

constexpr double kGrainRadius_m = 0.005;

class RandomGrains {
 public:
  RandomGrains(unsigned seed, std::size_t count, btScalar size_m) : random_(seed) {
    std::uniform_real_distribution<btScalar> place(-size_m / 2, size_m / 2);
    btVector3 inertia;
    shape_.calculateLocalInertia(1, inertia);
    for (std::size_t i = 0; i < count; ++i) {
      auto& grain =
          grains_.emplace_back(std::make_unique<btRigidBody>(1, nullptr, &shape_, inertia));
      grain->setUserIndex(7);
      grain->setUserIndex2(kGrain);
      btTransform X_WG = btTransform::getIdentity();
      X_WG.setOrigin({place(random_), place(random_), place(random_)});
      grain->setWorldTransform(X_WG);
      contacts_.Add(*grain);
    }
  }
  using Pairs = std::set<std::pair<const btRigidBody*, const btRigidBody*>>;
  Pairs Found() {
    contacts_.Find();
    Pairs pairs;
    for (const GrainContact& contact : contacts_.contacts())
      EXPECT_TRUE(pairs.emplace(contact.a, contact.b).second) << "found twice";
    return pairs;
  }
  Pairs ThatTouch() const {
    Pairs pairs;
    for (std::size_t i = 0; i < grains_.size(); ++i)
      for (std::size_t j = i + 1; j < grains_.size(); ++j)
        if ((Place(i) - Place(j)).length() <= 2 * kGrainRadius_m)
          pairs.emplace(grains_[i].get(), grains_[j].get());
    return pairs;
  }
  GrainContacts& contacts() { return contacts_; }
  btRigidBody& grain(std::size_t i) { return *grains_[i]; }

 private:
  btVector3 Place(std::size_t i) const { return grains_[i]->getWorldTransform().getOrigin(); }

  std::mt19937 random_;
  btSphereShape shape_{kGrainRadius_m};
  std::vector<std::unique_ptr<btRigidBody>> grains_;
  GrainContacts contacts_;
};

TEST(GrainContacts, AreThoseOfASearchOfAllPairs) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    RandomGrains grains(seed, 200, 0.03 + 0.004 * seed);
    const RandomGrains::Pairs touch = grains.ThatTouch();
    ASSERT_GT(touch.size(), 2u);
    EXPECT_EQ(grains.Found(), touch) << "seed " << seed;
  }
}

TEST(GrainContacts, EndWhenTheGapIsWide) {
  RandomGrains grains(1, 2, 0.001);
  const auto apart = [&](btScalar gap_m) {
    for (std::size_t i = 0; i < 2; ++i) {
      btTransform X_WG = btTransform::getIdentity();
      X_WG.setOrigin({i * (2 * kGrainRadius_m + gap_m), 0, 0});
      grains.grain(i).setWorldTransform(X_WG);
    }
    return grains.Found().size();
  };
  EXPECT_EQ(apart(1e-6), 0u) << "not touched yet";
  EXPECT_EQ(apart(-1e-6), 1u);
  EXPECT_EQ(apart(0.9e-4), 1u) << "near, and touched before";
  EXPECT_EQ(apart(1.1e-4), 0u);
  EXPECT_EQ(apart(0.9e-4), 0u);
}

/// One grain hits another, which rests, along x with 1 m/s and across it with `slip_m_per_s`;
/// without gravity. Speeds across it after the tick.
struct AfterHit {
  btVector3 first, second;
};

AfterHit Hit(btScalar slip_m_per_s, btScalar friction) {
  const std::unique_ptr<BulletEngine> engine = MakeBulletEngine(BulletParts::kReplaced);
  engine->world().setGravity({0, 0, 0});
  engine->world().getSolverInfo().m_numIterations = 50;
  btSphereShape shape(kGrainRadius_m);
  btVector3 inertia;
  shape.calculateLocalInertia(1, inertia);
  btRigidBody first(1, nullptr, &shape, inertia), second(1, nullptr, &shape, inertia);
  for (btRigidBody* grain : {&first, &second}) {
    grain->setUserIndex(0);
    grain->setUserIndex2(kGrain);
    grain->setFriction(friction);
    engine->world().addRigidBody(grain);
  }
  btTransform X_WG = btTransform::getIdentity();
  X_WG.setOrigin({2 * kGrainRadius_m - 1e-9, 0, 0});
  second.setWorldTransform(X_WG);
  first.setLinearVelocity({1, slip_m_per_s, 0});
  engine->world().stepSimulation(1.0 / 480, 0);
  const AfterHit after{first.getLinearVelocity(), second.getLinearVelocity()};
  for (btRigidBody* grain : {&first, &second}) engine->world().removeRigidBody(grain);
  return after;
}

TEST(GrainContacts, AHitSharesTheSpeedAlongTheNormal) {
  const AfterHit after = Hit(0, 0);
  EXPECT_NEAR(after.first.x(), 0.5, 1e-6);
  EXPECT_NEAR(after.second.x(), 0.5, 1e-6);
}

/// Two equal spheres that end without sliding: a seventh of the slip goes over, the rest is spin.
TEST(GrainContacts, FrictionStopsTheSlip) {
  const AfterHit after = Hit(/*slip_m_per_s=*/0.7, /*friction=*/1);
  EXPECT_NEAR(after.first.y(), 0.6, 1e-6);
  EXPECT_NEAR(after.second.y(), 0.1, 1e-6);
}

TEST(GrainContacts, FrictionIsAtMostItsShareOfThePressure) {
  const AfterHit after = Hit(/*slip_m_per_s=*/7, /*friction=*/0.5);
  EXPECT_NEAR(after.first.y(), 7 - 0.25 * 0.5, 1e-6) << "friction 0.25, impulse 0.5 of the mass";
  EXPECT_NEAR(after.second.y(), 0.25 * 0.5, 1e-6);
}

/// Peas in a fixed mug.
Scene MugOfPeas(int count, Engine engine) {
  Scene scene;
  scene.world.engine = engine;
  scene.bodies.push_back(
      {.name = "mug", .shapes = ShapesOf(Mug{.radius_m = 0.04, .height_m = 0.1}), .fixed = true});
  Body peas{.name = "peas",
            .shapes = {},
            .grains = Grains{.radius_m = kGrainRadius_m, .p_WG_m = {}},
            .mass_kg = 0.1};
  peas.friction = 0.4;
  peas.rolling_friction = 0;
  peas.grains->p_WG_m = FillVessel(scene.bodies[0], kGrainRadius_m, count, 1);
  scene.bodies.push_back(peas);
  return scene;
}

struct Overlap {
  double mean_m = 0, largest_m = 0;  ///< of touching grains, over the last second
  double height_m = 0;               ///< of the grains' centre, at the end
};

Overlap AfterSettling(Engine engine) {
  Simulation simulation(MugOfPeas(200, engine), Script{.stages = {}, .settle_s = 2});
  Overlap overlap;
  int count = 0;
  while (simulation.Step()) {
    const auto& grains = simulation.snapshot().grains;
    if (simulation.snapshot().tick < 480) continue;
    for (std::size_t i = 0; i < grains.size(); ++i)
      for (std::size_t j = i + 1; j < grains.size(); ++j) {
        const double overlap_m = 2 * kGrainRadius_m - (grains[i] - grains[j]).norm();
        if (overlap_m <= 0) continue;
        overlap.mean_m += overlap_m;
        overlap.largest_m = std::max(overlap.largest_m, overlap_m);
        ++count;
      }
  }
  EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kCompleted) << simulation.status().reason;
  overlap.mean_m /= count;
  overlap.height_m = simulation.snapshot().bodies[1].X_WB.p_m.z();
  return overlap;
}

TEST(GrainContacts, AHeapIsAsStiffAsInStockBullet) {
  const Overlap ours = AfterSettling(Engine::kBullet), stock = AfterSettling(Engine::kBulletStock);
  EXPECT_LT(ours.mean_m, stock.mean_m);
  EXPECT_LT(ours.largest_m, stock.largest_m);
  EXPECT_NEAR(ours.height_m, stock.height_m, 0.001);
}

}  // namespace
}  // namespace prehend::physics
