// SPDX-License-Identifier: Apache-2.0
// In a crowd, what stands still when the scene begins sleeps at once; what moves does not.
#include "physics/bullet/first_rest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "physics/simulation.h"

namespace prehend::physics {
namespace {

constexpr double kSize_m = 0.1, kSpacing_m = 0.2;
constexpr int kSide = 11;
constexpr int kCrowd = static_cast<int>(FirstRest::kCrowd);

/// Boxes side by side on a floor, body 0.
Scene Boxes(int count) {
  Scene scene;
  Body floor{.name = "floor", .fixed = true};
  floor.shapes.push_back({Box{{6, 6, kSize_m}}, {}});
  floor.X_WB.p_m = {0, 0, -kSize_m / 2};
  scene.bodies.push_back(floor);
  for (int i = 0; i < count; ++i) {
    Body box{.name = "box" + std::to_string(i), .mass_kg = 0.3};
    box.shapes.push_back({Box{{kSize_m, kSize_m, kSize_m}}, {}});
    box.X_WB.p_m = {kSpacing_m * (i % kSide), kSpacing_m * (i / kSide), kSize_m / 2};
    scene.bodies.push_back(box);
  }
  return scene;
}

/// The tick at which all boxes sleep; -1 if they do not by then.
int AsleepAt(Scene scene, int at_most) {
  Simulation simulation(std::move(scene), Script{.stages = {}, .settle_s = 1});
  for (int tick = 1; tick <= at_most && simulation.Step(); ++tick) {
    const auto& bodies = simulation.snapshot().bodies;
    if (std::ranges::all_of(bodies.begin() + 1, bodies.end(), &BodyState::asleep)) return tick;
  }
  return -1;
}

Snapshot Settled(const Scene& scene, double settle_s) {
  Simulation simulation(scene, Script{.stages = {}, .settle_s = settle_s});
  while (simulation.Step()) {
  }
  EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kCompleted) << simulation.status().reason;
  return simulation.snapshot();
}

int Asleep(const Snapshot& snapshot) {
  int count = 0;
  for (const BodyState& body : snapshot.bodies) count += body.asleep ? 1 : 0;
  return count;
}

TEST(FirstRest, ACrowdThatStandsStillSleepsAtOnce) {
  const Scene scene = Boxes(kCrowd);
  const Snapshot end = Settled(scene, 0.1);
  EXPECT_EQ(Asleep(end), kCrowd);
  for (std::size_t i = 1; i < scene.bodies.size(); ++i)
    EXPECT_LT((end.bodies[i].X_WB.p_m - scene.bodies[i].X_WB.p_m).norm(), 1e-5);
  ASSERT_TRUE(end.resting) << "what stands on the floor touches it";
  EXPECT_EQ(end.resting->size(), 4u * static_cast<std::size_t>(kCrowd));
}

/// Where the height of a floor and that of a box round to a gap, the box falls for a tick.
TEST(FirstRest, ACrowdSleepsByTick30AtEveryHeightAndRate) {
  for (int i = 0; i < 20; ++i) {
    for (const int rate_hz : {240, 480, 960}) {
      Scene scene = Boxes(kCrowd);
      scene.world.rate_hz = rate_hz;
      const double top_m = 0.04 + 0.0517 * i, thick_m = i % 2 == 0 ? 0.04 : 1;
      scene.bodies[0].shapes.front().shape = Box{{6, 6, thick_m}};
      scene.bodies[0].X_WB.p_m.z() = top_m - thick_m / 2;
      for (std::size_t k = 1; k < scene.bodies.size(); ++k)
        scene.bodies[k].X_WB.p_m.z() = top_m + kSize_m / 2;
      EXPECT_NE(AsleepAt(scene, 30), -1) << top_m << " m, " << rate_hz << " Hz";
    }
  }
}

TEST(FirstRest, WhatStandsAMicrometreAboveSleepsByTick30) {
  for (const double gap_m : {1e-7, 1e-6, 1e-5, -1e-6, -1e-5}) {
    Scene scene = Boxes(kCrowd);
    for (std::size_t k = 1; k < scene.bodies.size(); ++k) scene.bodies[k].X_WB.p_m.z() += gap_m;
    EXPECT_NE(AsleepAt(scene, 30), -1) << gap_m;
  }
}

/// They settle from below to above.
TEST(FirstRest, StacksOfACrowdSleepByTick40) {
  for (const double top_m : {0.0, 0.3, 0.76}) {
    for (const int high : {2, 3, 4}) {
      Scene scene = Boxes(kCrowd + 20);
      scene.bodies[0].X_WB.p_m.z() = top_m - kSize_m / 2;
      for (int i = 0; i < kCrowd + 20; ++i) {
        const int column = i / high;
        scene.bodies[static_cast<std::size_t>(1 + i)].X_WB.p_m = {
            kSpacing_m * (column % kSide), kSpacing_m * (column / kSide),
            top_m + kSize_m * (i % high + 0.5)};
      }
      EXPECT_NE(AsleepAt(scene, 40), -1) << top_m << " m, " << high << " high";
    }
  }
}

TEST(FirstRest, FewBodiesWaitForTwoSeconds) {
  EXPECT_EQ(Asleep(Settled(Boxes(kCrowd - 1), 1)), 0);
  EXPECT_EQ(Asleep(Settled(Boxes(kCrowd - 1), 2.2)), kCrowd - 1);
}

TEST(FirstRest, WhatFallsIsAwake) {
  Scene scene = Boxes(kCrowd);
  scene.bodies[7].X_WB.p_m.z() += 0.001;
  const Snapshot end = Settled(scene, 0.1);
  EXPECT_EQ(Asleep(end), kCrowd - 1);
  EXPECT_FALSE(end.bodies[7].asleep);
  EXPECT_NEAR(end.bodies[7].X_WB.p_m.z(), kSize_m / 2, 1e-4);
}

TEST(FirstRest, ATowerFromWhichOneFallsIsAwakeAsAWhole) {
  Scene scene = Boxes(kCrowd + 1);
  scene.bodies.back().X_WB.p_m = scene.bodies[7].X_WB.p_m + Eigen::Vector3d(0.055, 0, kSize_m);
  const Snapshot begin = Settled(scene, 0.1);
  EXPECT_FALSE(begin.bodies.back().asleep) << "its middle is not above the box below";
  EXPECT_FALSE(begin.bodies[7].asleep);
  EXPECT_GT(Asleep(begin), kCrowd - 4);
}

/// A slope barely steeper than the friction angle: 0.02 m/s^2 are 1 mm/s after the first ticks.
TEST(FirstRest, WhatBeginsToSlideSlowlyIsAwake) {
  constexpr double kFriction = 0.3, kAcceleration = 0.02;
  const double slope_rad = std::atan(kFriction) + kAcceleration / 9.81;
  Scene scene = Boxes(kCrowd);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(slope_rad, Eigen::Vector3d::UnitY()));
  Body board{.name = "board", .fixed = true};
  board.shapes.push_back({Box{{1, 0.3, 0.02}}, {}});
  board.X_WB = {{-1, 0, 1}, turn};
  board.friction = 1;
  Body& box = scene.bodies.back();
  box.friction = kFriction;
  box.X_WB = {board.X_WB.p_m + turn * Eigen::Vector3d(-0.3, 0, 0.01 + kSize_m / 2), turn};
  const Eigen::Vector3d start = box.X_WB.p_m;
  scene.bodies.push_back(board);
  const Snapshot end = Settled(scene, 1);
  const std::size_t i = scene.bodies.size() - 2;
  EXPECT_FALSE(end.bodies[i].asleep);
  EXPECT_GT((end.bodies[i].X_WB.p_m - start).norm(), 0.004);
}

TEST(FirstRest, WhoIsHitWakes) {
  Scene scene = Boxes(kCrowd);
  Body ball{.name = "ball", .mass_kg = 1};
  ball.shapes.push_back({Sphere{0.03}, {}});
  ball.X_WB.p_m = scene.bodies[7].X_WB.p_m + Eigen::Vector3d(0.03, 0, 0.3);
  scene.bodies.push_back(ball);
  const Snapshot before = Settled(scene, 0.15), hit = Settled(scene, 0.4);
  EXPECT_TRUE(before.bodies[7].asleep);
  EXPECT_FALSE(hit.bodies[7].asleep);
  EXPECT_TRUE(hit.bodies[50].asleep);
}

}  // namespace
}  // namespace prehend::physics
