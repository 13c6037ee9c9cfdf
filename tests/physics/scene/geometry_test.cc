// SPDX-License-Identifier: Apache-2.0
#include "physics/scene/geometry.h"

#include <gtest/gtest.h>

#include <numbers>

namespace prehend::physics {
namespace {

using Eigen::AngleAxisd, Eigen::Quaterniond, Eigen::Vector3d;

const Quaterniond kLying(AngleAxisd(std::numbers::pi / 2, Vector3d::UnitX()));
const Quaterniond kLeaning(AngleAxisd(std::numbers::pi / 4, Vector3d::UnitX()));

struct DistanceCase {
  Shape shape;
  Vector3d p;
  double distance;
};

TEST(GeometryTest, SignedDistances) {
  const DistanceCase cases[] = {
      {Box{{2, 2, 2}}, {0, 0, 0}, -1},     {Box{{2, 2, 2}}, {3, 0, 0}, 2},
      {Box{{2, 2, 2}}, {4, 5, 0}, 5},      {Sphere{1}, {0, 3, 0}, 2},
      {Cylinder{1, 2}, {0, 0, 3}, 2},      {Cylinder{1, 2}, {4, 0, 5}, 5},
      {Cylinder{1, 2}, {0.5, 0, 0}, -0.5}, {Capsule{1, 2}, {0, 0, 3}, 1},
      {Capsule{1, 2}, {0, 2, 0.5}, 1},
  };
  for (const DistanceCase& c : cases)
    EXPECT_NEAR(SignedDistance(c.shape, c.p), c.distance, 1e-12) << c.p.transpose();
}

TEST(GeometryTest, WorldBoundsAreTight) {
  EXPECT_NEAR(WorldBounds(Shape(Cylinder{0.1, 1}), {{0, 0, 0}, kLying}).max().y(), 0.5, 1e-12);
  EXPECT_NEAR(WorldBounds(Shape(Cylinder{0.1, 1}), {{0, 0, 0}, kLeaning}).max().z(),
              0.6 * std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(WorldBounds(Shape(Capsule{0.1, 1}), {{0, 0, 2}, kLeaning}).min().z(),
              1.9 - 0.5 * std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(WorldBounds(Shape(Sphere{0.1}), {{0, 0, 0}, kLeaning}).max().z(), 0.1, 1e-12);
  EXPECT_NEAR(WorldBounds(Shape(Box{{1, 1, 1}}), {{0, 0, 0}, kLeaning}).max().z(), std::sqrt(0.5),
              1e-12);
}

TEST(GeometryTest, TheBoundingBoxOfACompoundHoldsAllParts) {
  const Body mug{.name = "mug",
                 .shapes = {{Cylinder{0.04, 0.1}, {}}, {Box{{0.02, 0.01, 0.06}}, {{0.05, 0, 0}}}},
                 .mass_kg = 0.3};
  const LocalBox box = BoundingBox(mug);
  EXPECT_LT((box.p_BC_m - Vector3d(0.01, 0, 0)).norm(), 1e-12);
  EXPECT_LT((box.half_size_m - Vector3d(0.05, 0.04, 0.05)).norm(), 1e-12);
}

TEST(GeometryTest, OnlyUprightRoundThingsLookTheSameAllAround) {
  const auto body = [](Shape shape) { return Body{.shapes = {{shape, {}}}}; };
  EXPECT_TRUE(IsRoundAboutVertical(body(Cylinder{}), {}));
  EXPECT_TRUE(IsRoundAboutVertical(body(Sphere{}), {{0, 0, 0}, kLying}));
  EXPECT_FALSE(IsRoundAboutVertical(body(Cylinder{}), {{0, 0, 0}, kLying}));
  EXPECT_FALSE(IsRoundAboutVertical(body(Box{}), {}));
}

}  // namespace
}  // namespace prehend::physics
