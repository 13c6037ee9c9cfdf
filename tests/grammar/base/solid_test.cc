// SPDX-License-Identifier: Apache-2.0
#include "grammar/base/solid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace prehend::grammar {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kNear_m = 2e-9;

double Distance(const Shape& shape, const Vector3d& p) { return Solid({{shape}}).DistanceTo(p); }

Hull Cuboid(const Vector3d& half_size) {
  Hull hull;
  for (const double x : {-1, 1})
    for (const double y : {-1, 1})
      for (const double z : {-1, 1})
        hull.points_m.push_back(half_size.cwiseProduct(Vector3d(x, y, z)));
  return hull;
}

/// A grid of points in and around the shapes below.
std::vector<Vector3d> Grid() {
  std::vector<Vector3d> grid;
  for (int x = -3; x <= 3; ++x)
    for (int y = -3; y <= 3; ++y)
      for (int z = -3; z <= 3; ++z) grid.emplace_back(0.071 * x, 0.083 * y, 0.097 * z);
  return grid;
}

TEST(Solid, DistancesKnownOnPaper) {
  const Box box{{0.1, 0.2, 0.3}};
  EXPECT_NEAR(Distance(box, {0.4, 0.6, 0.3}), 0.5, kNear_m) << "from an edge: 3, 4, 5";
  EXPECT_EQ(Distance(box, {0.1, -0.2, 0.3}), 0) << "a corner";
  EXPECT_NEAR(Distance(Ball{0.05}, {0.3, 0.4, 0}), 0.45, kNear_m);
  const Cylinder cylinder{0.1, 0.05};
  EXPECT_NEAR(Distance(cylinder, {0.12, 0.16, 0}), 0.1, kNear_m) << "from its side";
  EXPECT_NEAR(Distance(cylinder, {0.05, 0.05, -0.25}), 0.2, kNear_m) << "from its base";
  EXPECT_NEAR(Distance(cylinder, {0.4, 0, 0.45}), 0.5, kNear_m) << "from its rim";
  EXPECT_EQ(Distance(cylinder, {0.06, 0.07, 0.04}), 0);
  const Capsule capsule{0.1, 0.2};
  EXPECT_NEAR(Distance(capsule, {0.25, 0, 0.2}), 0.15, kNear_m) << "from its side";
  EXPECT_NEAR(Distance(capsule, {0, 0.3, -0.6}), 0.4, kNear_m) << "from its round end";
  EXPECT_EQ(Distance(capsule, {0, 0, 0.29}), 0);
}

TEST(Solid, DistancesFromAHullKnownOnPaper) {
  // A wedge whose slope is the plane 3 x + 4 z = 1.2 (metres), the origin in its right angle.
  const Hull wedge{{{0, 0, 0}, {0.4, 0, 0}, {0, 0, 0.3}, {0, 1, 0}, {0.4, 1, 0}, {0, 1, 0.3}}};
  EXPECT_NEAR(Distance(wedge, {0.4, 0.5, 0.4}), (3 * 0.4 + 4 * 0.4 - 1.2) / 5, kNear_m)
      << "from its slope";
  EXPECT_NEAR(Distance(wedge, {-0.3, 0.5, -0.4}), 0.5, kNear_m) << "from an edge";
  EXPECT_NEAR(Distance(wedge, {-0.2, -0.3, -0.6}), 0.7, kNear_m) << "from a corner: 2, 3, 6";
  EXPECT_EQ(Distance(wedge, {0.1, 0.5, 0.1}), 0);
  EXPECT_EQ(Distance(wedge, {0.2, 0.5, 0.15}), 0) << "on its slope";
  EXPECT_NEAR(Distance(wedge, {3000, 0.5, 4000}), (3 * 3000 + 4 * 4000 - 1.2) / 5, 1e-6)
      << "far away, before the foot leaves the slope";
}

TEST(Solid, AHullOfTheCornersOfABoxIsThatBox) {
  const Vector3d half_size(0.1, 0.07, 0.15);
  const Solid box({{Box{half_size}}}), hull({{Cuboid(half_size)}});
  for (const Vector3d& p : Grid())
    EXPECT_NEAR(hull.DistanceTo(p), box.DistanceTo(p), kNear_m) << p.transpose();
}

TEST(Solid, PointsInsideOfAHullAndTwiceChangeNothing) {
  Hull hull = Cuboid({0.1, 0.07, 0.15});
  const Solid plain({{hull}});
  hull.points_m.insert(hull.points_m.begin(), {0.01, 0.02, 0.03});
  hull.points_m.push_back(hull.points_m[3]);
  hull.points_m.emplace_back(0, 0.07, 0);
  for (const Vector3d& p : Grid())
    EXPECT_NEAR(Solid({{hull}}).DistanceTo(p), plain.DistanceTo(p), kNear_m) << p.transpose();
}

TEST(Solid, ManySidedHullsAreAlmostRound) {
  constexpr int kSides = 32;
  Hull prism;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    for (const double z : {-0.02, 0.02})
      prism.points_m.emplace_back(0.1 * std::cos(angle), 0.1 * std::sin(angle), z);
  }
  const double least = 0.1 * (1 - std::cos(std::numbers::pi / kSides));
  for (const Vector3d& p : Grid()) {
    const double round = Distance(Cylinder{0.1, 0.02}, p);
    EXPECT_GE(Distance(prism, p), round - kNear_m) << p.transpose();
    EXPECT_LE(Distance(prism, p), round + least + kNear_m) << p.transpose();
  }
}

TEST(Solid, PartsArePlacedAndTheNearestCounts) {
  const Quaterniond lying(AngleAxisd(std::numbers::pi / 2, Vector3d::UnitY()));  // along x
  const Solid column({{Cylinder{0.02, 0.3}, {0.1, 0, 0.5}, lying}, {Box{{0.5, 0.5, 0.01}}}});
  EXPECT_NEAR(column.DistanceTo({0.45, 0, 0.5}), 0.05, kNear_m) << "from the end of the bar";
  EXPECT_NEAR(column.DistanceTo({0.1, 0, 0.4}), 0.08, kNear_m) << "from below the bar";
  EXPECT_NEAR(column.DistanceTo({0.1, 0, 0.1}), 0.09, kNear_m) << "from above the foot";
  const Quaterniond turned(AngleAxisd(std::numbers::pi / 4, Vector3d::UnitZ()));
  EXPECT_NEAR(Solid({{Box{{0.1, 0.1, 0.1}}, {0, 0, 0}, turned}}).DistanceTo({0.3, 0, 0}),
              0.3 - 0.1 * std::numbers::sqrt2, kNear_m);
}

TEST(Solid, NoDistanceIsAboveTheMostThatMatters) {
  const Solid solid({{Ball{0.1}, {1, 0, 0}}, {Cuboid({0.1, 0.1, 0.1}), {-1, 0, 0}}});
  for (const Vector3d& p : Grid())
    for (const double most_m : {0.0, 0.5, 0.8, 1.0})
      EXPECT_EQ(solid.DistanceTo(p, most_m), std::min(most_m, solid.DistanceTo(p)));
}

}  // namespace
}  // namespace prehend::grammar
