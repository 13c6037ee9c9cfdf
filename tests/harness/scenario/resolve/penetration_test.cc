// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numbers>

#include "harness/scenario/resolve/resolve.h"

namespace prehend::scenario {
namespace {

using physics::Box;
using physics::Cylinder;
using physics::Sphere;

PlacedSolid At(physics::Shape shape, Eigen::Vector3d p_m, double yaw_deg = 0) {
  return {shape,
          {p_m, Eigen::Quaterniond(Eigen::AngleAxisd(yaw_deg * std::numbers::pi / 180,
                                                     Eigen::Vector3d::UnitZ()))}};
}

struct Overlap {
  const char* what;
  PlacedSolid a, b;
  double depth_m;
};

TEST(Penetration, IsKnownForSimpleCases) {
  const Box cube{{2, 2, 2}};
  const double s = std::sqrt(0.5);
  const Overlap table[] = {
      {"boxes overlap", At(cube, {0, 0, 0}), At(cube, {1.9, 0.5, 0}), 0.1},
      {"boxes touch", At(cube, {0, 0, 0}), At(cube, {2, 0, 0}), 0},
      {"boxes apart", At(cube, {0, 0, 0}), At(cube, {2.5, 0, 0}), -0.5},
      {"turned box, its edge first", At(cube, {0, 0, 0}), At(cube, {1 + 2 * s, 0, 0}, 45), 0},
      {"spheres overlap on the diagonal", At(Sphere{1}, {0, 0, 0}),
       At(Sphere{1}, {1.8 * s, 1.8 * s, 0}), 0.2},
      {"sphere at a corner of a box", At(cube, {0, 0, 0}), At(Sphere{1}, {1.8, 1.8, 0}),
       1 - 0.8 / s},
      {"cylinders side by side on the diagonal", At(Cylinder{1, 2}, {0, 0, 0}),
       At(Cylinder{1, 2}, {2 * s, 2 * s, 0.3}, 20), 0},
      {"cylinder at a corner of a box", At(cube, {0, 0, 0}), At(Cylinder{1, 2}, {1.8, 1.8, 0.5}),
       1 - 0.8 / s},
      {"cylinder on a box", At(cube, {0, 0, 0}), At(Cylinder{0.1, 1}, {0.3, 0.2, 1.5}), 0},
      {"the same place", At(cube, {0, 0, 0}), At(cube, {0, 0, 0}), 2},
  };
  for (const Overlap& c : table) {
    EXPECT_NEAR(Penetration(c.a, c.b), c.depth_m, 1e-9) << c.what;
    EXPECT_NEAR(Penetration(c.b, c.a), c.depth_m, 1e-9) << c.what << ", the other way round";
  }
}

TEST(Penetration, CapsulesHaveRoundEnds) {
  const PlacedSolid capsule = At(physics::Capsule{0.5, 1}, {0, 0, 0});
  EXPECT_NEAR(Penetration(capsule, At(Sphere{0.5}, {0, 0, 1.4})), 0.1, 1e-9);
}

}  // namespace
}  // namespace prehend::scenario
