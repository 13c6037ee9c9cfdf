// SPDX-License-Identifier: Apache-2.0
// Engine::kBulletStock plays the same scenes without our replacements of Bullet's parts, and shows
// what each of them is for: physics/bullet/core/README.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/bullet/world.h"
#include "physics/simulation.h"
#include "tests/physics/tabletop.h"

namespace prehend::physics {
namespace {

Scene FallingOnAFloor(const Shape& shape, double centre_m, double restitution, Engine engine) {
  const Body floor{.name = "floor",
                   .shapes = {{Box{{2, 2, 0.1}}, {}}},
                   .fixed = true,
                   .restitution = 1,
                   .X_WB = {{0, 0, -0.05}}};
  const Body thing{.name = "thing",
                   .shapes = {{shape, {}}},
                   .mass_kg = 0.2,
                   .restitution = restitution,
                   .X_WB = {{0, 0, centre_m}}};
  Scene scene{.bodies = {floor, thing}};
  scene.world.engine = engine;
  return scene;
}

/// The largest `value` of a snapshot within so many ticks.
template <class Value>
double Largest(const Scene& scene, int ticks, Value value) {
  const auto world = MakeBulletWorld(scene, {});
  Snapshot now;
  double largest = -HUGE_VAL;
  for (int i = 0; i < ticks; ++i) {
    world->Step({});
    world->Describe(now);
    largest = std::max(largest, value(now));
  }
  return largest;
}

double ReboundSpeed_m_per_s(Engine engine) {
  constexpr double kRadius_m = 0.2;
  const Scene scene = FallingOnAFloor(Sphere{kRadius_m}, kRadius_m + 0.4, 0.81, engine);
  return Largest(scene, 240, [](const Snapshot& s) { return s.bodies[1].v_WB_m_per_s.z(); });
}

double TurnAfterFallingFlat_rad_per_s(Engine engine) {
  const Scene scene = FallingOnAFloor(Cylinder{0.033, 0.12}, 0.06 + 0.44, 0, engine);
  return Largest(scene, 240, [](const Snapshot& s) { return s.bodies[1].w_WB_rad_per_s.norm(); });
}

/// How far a block slides on a board that tips by 40 degrees; it should from 12 degrees on.
double SlideOnATippingBoard_m(Engine engine) {
  constexpr double kEnd_rad = 40 * kRadPerDeg;
  Scene scene;
  scene.bodies = {{.name = "post",
                   .shapes = {{Box{{0.05, 0.1, 0.2}}, {}}},
                   .fixed = true,
                   .X_WB = {{0, 0, 0.8}}},
                  {.name = "board",
                   .shapes = {{Box{{0.6, 0.1, 0.02}}, {}}},
                   .mass_kg = 1,
                   .friction = 1,
                   .X_WB = {{0, 0, 1}}},
                  {.name = "block",
                   .shapes = {{Box{{0.06, 0.06, 0.06}}, {}}},
                   .mass_kg = 0.5,
                   .friction = 0.2,
                   .X_WB = {{0.1, 0, 1.04}}}};
  scene.joints = {{.kind = JointKind::kHinge,
                   .body = BodyIndex(1),
                   .base = BodyIndex(0),
                   .pivot_W_m = {0, 0, 1},
                   .axis_W = Eigen::Vector3d::UnitY(),
                   .lower = -kEnd_rad,
                   .upper = kEnd_rad,
                   .damping = 2}};
  scene.world.engine = engine;
  return Largest(scene, 2 * 480, [](const Snapshot& s) {
    return (s.bodies[1].X_WB.inverse() * s.bodies[2].X_WB).p_m.x() - 0.1;
  });
}

TEST(StockBulletTest, ABallReboundsTooSlowly) {
  const double right_m_per_s = 0.81 * std::sqrt(2 * 9.81 * 0.4);
  EXPECT_NEAR(ReboundSpeed_m_per_s(Engine::kBullet), right_m_per_s, 0.05);
  EXPECT_LT(ReboundSpeed_m_per_s(Engine::kBulletStock), right_m_per_s - 0.2);
}

TEST(StockBulletTest, ACanThatFallsFlatTips) {
  EXPECT_LT(TurnAfterFallingFlat_rad_per_s(Engine::kBullet), 0.1);
  EXPECT_GT(TurnAfterFallingFlat_rad_per_s(Engine::kBulletStock), 1);
}

TEST(StockBulletTest, ABlockOnATippingBoardDoesNotSlide) {
  EXPECT_GT(SlideOnATippingBoard_m(Engine::kBullet), 0.1);
  EXPECT_LT(SlideOnATippingBoard_m(Engine::kBulletStock), 0.01);
}

TEST(StockBulletTest, AHandPicksUpAndPlaces) {
  Scene scene = MakeScene(Tabletop{});
  scene.world.engine = Engine::kBulletStock;
  Simulation simulation(scene, MakeScript(PickAndPlace{}));
  double highest_m = 0;
  do {
    highest_m = std::max(highest_m, simulation.snapshot().bodies[kObject].X_WB.p_m.z());
  } while (simulation.Step());
  EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kCompleted) << simulation.status().reason;
  EXPECT_GT(highest_m, kTop_m + 0.15) << "it was not lifted";
  const Eigen::Vector3d& end_m = simulation.snapshot().bodies[kObject].X_WB.p_m;
  EXPECT_LT((end_m.head<2>() - PickAndPlace{}.to_m).norm(), 0.05);
}

TEST(StockBulletTest, RunsAreDeterministic) {
  const auto hash = [] {
    Scene scene = MakeScene(Tabletop{});
    scene.world.engine = Engine::kBulletStock;
    Simulation simulation(scene, MakeScript(PickAndPlace{}));
    for (int i = 0; i < 960 && simulation.Step(); ++i) {
    }
    return simulation.state_hash();
  };
  EXPECT_EQ(hash(), hash());
}

}  // namespace
}  // namespace prehend::physics
