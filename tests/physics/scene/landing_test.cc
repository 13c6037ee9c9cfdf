// SPDX-License-Identifier: Apache-2.0
#include "physics/scene/landing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "physics/scene/compounds.h"

namespace prehend::physics {
namespace {

using Eigen::Vector3d;

constexpr double kNear_m = 1e-6;

Body Of(Shape shape) { return {.shapes = {{std::move(shape), {}}}}; }
Pose At(const Vector3d& p_m, const Vector3d& rpy_deg = Vector3d::Zero()) {
  return {p_m, FromRollPitchYaw(rpy_deg)};
}
const double kTan15 = std::tan(15 * std::numbers::pi / 180);
const double kCos15 = std::cos(15 * std::numbers::pi / 180);

TEST(LandingTest, ALevelSurfaceHasItsOwnHeightToTheBit) {
  const Body table = Of(Box{{1.2, 0.8, 0.04}}), milk = Of(Box{{0.07, 0.07, 0.2}});
  for (const double yaw : {0.0, 17.0, 90.0}) {
    const auto landing =
        LandingHeight(table, At({0, 0, 0.74}), milk, At({0.2, 0.1, 1.3}, {0, 0, yaw}));
    EXPECT_EQ(landing, 0.74 + 0.02);
  }
}

TEST(LandingTest, WhatStandsAlreadyLandsWhereItStands) {
  const Body table = Of(Box{{1.2, 0.8, 0.04}}), book = Of(Box{{0.02, 0.12, 0.2}});
  unsigned random = 1;
  const auto within = [&](double most) {
    random = random * 1664525u + 1013904223u;
    return most * (2 * (random / 4294967296.0) - 1);
  };
  for (int i = 0; i < 6000; ++i) {
    // What rests is turned by next to nothing.
    const double turned_deg = i % 2 == 0 ? 0.02 : std::pow(10, -3 - within(3));
    const Vector3d at(within(0.4), within(0.2), 0.86 + within(0.0005)),
        turn(within(turned_deg), within(turned_deg), within(0.3));
    const auto landing = LandingHeight(table, At({0, 0, 0.74}), book, At(at, turn));
    ASSERT_TRUE(landing) << at.transpose() << ", " << turn.transpose();
    EXPECT_NEAR(*landing, 0.76, kNear_m) << at.transpose() << ", " << turn.transpose();
  }
}

TEST(LandingTest, OnATiltedBoardOnlyWhatIsBelowCounts) {
  const Body board = Of(Box{{0.6, 0.3, 0.02}});
  const Pose X_WS = At({0, 0, 1}, {0, -15, 0});  // it rises along x
  const auto surface = [](double x) { return 1 + 0.01 / kCos15 + x * kTan15; };
  // Upright, it lands on its uphill edge; turned like the board, flat on its face.
  EXPECT_NEAR(*LandingHeight(board, X_WS, Of(Box{{0.06, 0.06, 0.1}}), At({-0.1, 0, 2})),
              surface(-0.07), kNear_m);
  const Pose X_WO = At({-0.1, 0, 2}, {0, -15, 0});
  const double lowest = surface(-0.1) + 0.05 / kCos15 - 0.05 * kCos15 - 0.03 * kTan15 * kCos15;
  EXPECT_NEAR(*LandingHeight(board, X_WS, Of(Box{{0.06, 0.06, 0.1}}), X_WO), lowest, kNear_m);
  const double ball = surface(-0.1) + 0.05 / kCos15 - 0.05;
  EXPECT_NEAR(*LandingHeight(board, X_WS, Of(Sphere{0.05}), At({-0.1, 0, 2})), ball, kNear_m);
}

TEST(LandingTest, OnAHullItIsTheSlopeBelow) {
  const Body wedge = Of(
      *MakeHull({{0, 0, 0}, {0.2, 0, 0}, {0, 0.1, 0}, {0.2, 0.1, 0}, {0, 0, 0.06}, {0, 0.1, 0.06}})
           .hull);
  const auto landing = LandingHeight(wedge, {}, Of(Cylinder{0.01, 0.1}), At({0.1, 0.05, 0.5}));
  EXPECT_NEAR(*landing, 0.06 * (1 - 0.09 / 0.2), kNear_m);
}

TEST(LandingTest, InABowlItIsTheFloorOrWhereTheWallIsTooNarrow) {
  const Body bowl{.shapes = ShapesOf(Bowl{.radius_m = 0.1, .height_m = 0.06, .wall_m = 0.006})};
  const Pose X_WS = At({0, 0, 0.79});
  EXPECT_NEAR(*LandingHeight(bowl, X_WS, Of(Box{{0.03, 0.03, 0.03}}), At({0, 0, 1})), 0.766,
              kNear_m);
  const double on_the_wall = *LandingHeight(bowl, X_WS, Of(Box{{0.1, 0.1, 0.03}}), At({0, 0, 1}));
  EXPECT_GT(on_the_wall, 0.78);
  EXPECT_LT(on_the_wall, 0.81);
  EXPECT_NEAR(*LandingHeight(bowl, X_WS, Of(Box{{0.3, 0.3, 0.03}}), At({0, 0, 1})), 0.82, 3e-3);
}

TEST(LandingTest, HollowsOfBothSidesCount) {
  const auto ring = [](double side_m) {
    const double at = side_m / 2;
    return Body{.shapes = {{Box{{0.02, side_m, 0.1}}, {{at, 0, 0}}},
                           {Box{{0.02, side_m, 0.1}}, {{-at, 0, 0}}},
                           {Box{{side_m, 0.02, 0.1}}, {{0, at, 0}}},
                           {Box{{side_m, 0.02, 0.1}}, {{0, -at, 0}}}}};
  };
  // A pea falls through a ring; a ring that is put over a post stands on what is around the post.
  EXPECT_EQ(LandingHeight(ring(0.2), {}, Of(Sphere{0.01}), At({0, 0, 1})), std::nullopt);
  Body post = Of(Box{{0.05, 0.05, 0.3}});
  post.shapes.push_back({Box{{0.5, 0.5, 0.02}}, {{0, 0, -0.15}}});
  EXPECT_NEAR(*LandingHeight(post, {}, ring(0.2), At({0, 0, 1})), -0.14, kNear_m);
  EXPECT_NEAR(*LandingHeight(post, {}, ring(0.2), At({0.1, 0, 1})), 0.15, kNear_m);
}

TEST(LandingTest, BoardsAboveTheObjectAreNotBelowIt) {
  const Body shelf{.shapes =
                       ShapesOf(Shelf{.size_m = {0.3, 0.4, 0.6}, .boards = 3, .wall_m = 0.02})};
  const Body cup = Of(Cylinder{0.03, 0.1});
  EXPECT_NEAR(*LandingHeight(shelf, {}, cup, At({-0.02, 0, 1})), 0.3, kNear_m);
  EXPECT_NEAR(*LandingHeight(shelf, {}, cup, At({-0.02, 0, 0.1})), 0.01, kNear_m);
  EXPECT_NEAR(*LandingHeight(shelf, {}, cup, At({-0.02, 0, 0.056})), 0.01, kNear_m);  // 4 mm inside
  EXPECT_NEAR(*LandingHeight(shelf, {}, cup, At({-0.02, 0, -0.1})), -0.28, kNear_m);
}

TEST(LandingTest, AThingRestsWithItsLowestPointOnTheSurface) {
  const Body board = Of(Box{{0.6, 0.3, 0.02}}), box = Of(Box{{0.06, 0.06, 0.1}});
  const auto level = RestOn(board, At({0, 0, 1}), box, At({-0.1, 0.05, 2}, {0, 0, 30}));
  ASSERT_TRUE(level);
  EXPECT_NEAR((level->p_m - Vector3d(-0.1, 0.05, 1.06)).norm(), 0, kNear_m);
  EXPECT_NEAR(level->q.angularDistance(FromRollPitchYaw({0, 0, 30})), 0, 1e-12);
  const auto tilted = RestOn(board, At({0, 0, 1}, {0, -15, 0}), box, At({-0.1, 0, 2}));
  ASSERT_TRUE(tilted);
  EXPECT_NEAR(tilted->p_m.z(), 1 + 0.01 / kCos15 - 0.07 * kTan15 + 0.05, kNear_m);
  EXPECT_FALSE(RestOn(board, At({0, 0, 1}), box, At({0.4, 0, 2})));
}

TEST(LandingTest, AboveIsWithinTheOutlineHollowsIncluded) {
  const Body wedge = Of(*MakeHull({{0, 0, 0}, {0.2, 0, 0}, {0, 0.2, 0}, {0, 0, 0.1}}).hull);
  EXPECT_TRUE(IsAbove(wedge, {}, {0.09, 0.09}));
  EXPECT_FALSE(IsAbove(wedge, {}, {0.11, 0.11}));  // within its bounding box
  const Body bowl{.shapes = ShapesOf(Bowl{.radius_m = 0.1, .height_m = 0.06})};
  EXPECT_TRUE(IsAbove(bowl, At({1, 0, 0}), {1, 0}));
  EXPECT_TRUE(IsAbove(bowl, At({1, 0, 0}), {1.09, 0}));
  EXPECT_FALSE(IsAbove(bowl, At({1, 0, 0}), {1.12, 0}));
  EXPECT_TRUE(IsAbove(Of(Box{{0.6, 0.3, 0.02}}), At({0, 0, 1}, {0, 60, 0}), {0.15, 0}));
  EXPECT_FALSE(IsAbove(Of(Box{{0.6, 0.3, 0.02}}), At({0, 0, 1}, {0, 60, 0}), {0.17, 0}));
}

}  // namespace
}  // namespace prehend::physics
