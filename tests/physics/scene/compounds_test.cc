// SPDX-License-Identifier: Apache-2.0
// Hollow things are as large as they say, are hollow, and hold what is put into them.
#include "physics/scene/compounds.h"

#include <gtest/gtest.h>

#include "physics/scene/geometry.h"
#include "physics/simulation.h"

namespace prehend::physics {
namespace {

using Eigen::Vector3d;

Body Thing(std::vector<PlacedShape> shapes, const Pose& X_WB = {}) {
  return {.name = "thing", .shapes = std::move(shapes), .mass_kg = 0.5, .X_WB = X_WB};
}

Vector3d SizeOf(const Body& body) { return 2 * BoundingBox(body).half_size_m; }

/// Distance from the nearest of its walls; negative inside one.
double FromWalls(const Body& body, const Vector3d& p_B) {
  double least = 1;
  for (const PlacedShape& placed : body.shapes)
    least = std::min(least, SignedDistance(placed.shape, placed.X_BS.inverse() * p_B));
  return least;
}

TEST(CompoundsTest, TheyAreAsLargeAsTheySay) {
  EXPECT_LT((SizeOf(Thing(ShapesOf(Tray{{0.4, 0.3, 0.04}}))) - Vector3d(0.4, 0.3, 0.04)).norm(),
            1e-12);
  EXPECT_LT((SizeOf(Thing(ShapesOf(Shelf{{0.3, 0.6, 0.8}, 3}))) - Vector3d(0.3, 0.6, 0.8)).norm(),
            1e-12);
  const Vector3d mug = SizeOf(Thing(ShapesOf(Mug{0.04, 0.1, 0.005, 0.03})));
  EXPECT_NEAR(mug.x(), 0.11, 0.001);
  EXPECT_NEAR(mug.y(), 0.08, 0.001);
  EXPECT_NEAR(mug.z(), 0.1, 1e-12);
  const Vector3d bowl = SizeOf(Thing(ShapesOf(Bowl{0.08, 0.06})));
  EXPECT_NEAR(bowl.x(), 0.16, 0.006);
  EXPECT_NEAR(bowl.z(), 0.06, 0.006);
}

TEST(CompoundsTest, TheyAreHollowAndClosedAround) {
  const Body mug = Thing(ShapesOf(Mug{0.04, 0.1, 0.005, 0}));
  EXPECT_NEAR(FromWalls(mug, {0, 0, 0}), 0.035, 0.001);
  const Body bowl = Thing(ShapesOf(Bowl{0.08, 0.06}));
  EXPECT_GT(FromWalls(bowl, {0, 0, 0}), 0.02);
  for (int i = 0; i < 360; ++i) {
    const Eigen::AngleAxisd turn(i * 0.01745, Vector3d::UnitZ());
    EXPECT_LT(FromWalls(mug, turn * Vector3d(0.0375, 0, 0)), 0) << i;
    EXPECT_LT(FromWalls(bowl, turn * Vector3d(0.057, 0, 0)), 0) << i;
  }
  const Body shelf = Thing(ShapesOf(Shelf{{0.3, 0.6, 0.8}, 3}));
  EXPECT_GT(FromWalls(shelf, {-0.2, 0, 0.2}), 0.05);
  EXPECT_LT(FromWalls(shelf, {0, 0, 0}), 0);
}

TEST(CompoundsTest, WhatIsInStaysIn) {
  const std::pair<const char*, std::vector<PlacedShape>> vessels[] = {
      {"tray", ShapesOf(Tray{{0.3, 0.3, 0.05}})},
      {"mug", ShapesOf(Mug{0.05, 0.1})},
      {"bowl", ShapesOf(Bowl{0.08, 0.06})}};
  for (const auto& [name, shapes] : vessels) {
    const Body vessel = Thing(shapes);
    const double height = SizeOf(vessel).z();
    Scene scene{.bodies = {{.name = "floor",
                            .shapes = {{Box{{2, 2, 0.1}}, {}}},
                            .fixed = true,
                            .X_WB = {{0, 0, -0.05}}},
                           Thing(shapes, {{0, 0, height / 2}}),
                           {.name = "ball",
                            .shapes = {{Sphere{0.02}, {}}},
                            .mass_kg = 0.05,
                            .rolling_friction = 0.006,
                            .X_WB = {{0.005, 0.003, height + 0.03}}}}};
    Simulation simulation(scene, {.settle_s = 2});
    while (simulation.Step()) {
    }
    const Vector3d& ball = simulation.snapshot().bodies[2].X_WB.p_m;
    EXPECT_NEAR(simulation.snapshot().bodies[1].X_WB.p_m.z(), height / 2, 0.002) << name;
    EXPECT_LT(ball.z(), 0.045) << name;
    EXPECT_GT(ball.z(), 0.02) << name;
  }
}

}  // namespace
}  // namespace prehend::physics
