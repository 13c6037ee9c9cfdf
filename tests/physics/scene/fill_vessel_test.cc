// SPDX-License-Identifier: Apache-2.0
#include "physics/scene/fill_vessel.h"

#include <gtest/gtest.h>

#include "physics/scene/compounds.h"
#include "physics/scene/geometry.h"

namespace prehend::physics {
namespace {

constexpr double kRadius_m = 0.005;

template <class Vessel>
Body Made(const Vessel& vessel) {
  return {.name = "vessel", .shapes = ShapesOf(vessel)};
}

/// In the hollow, and clear of the walls and of each other.
void ExpectLoose(const Body& vessel, const std::vector<Eigen::Vector3d>& grains,
                 double radius_m = kRadius_m) {
  for (std::size_t i = 0; i < grains.size(); ++i) {
    EXPECT_TRUE(IsInside(vessel, Pose{}, grains[i]));
    EXPECT_GT(DistanceTo(vessel, grains[i]), radius_m * 0.99);
    for (std::size_t j = 0; j < i; ++j)
      ASSERT_GT((grains[i] - grains[j]).norm(), 2 * radius_m) << i << " " << j;
  }
}

TEST(FillVessel, GrainsLieInTheHollow) {
  for (const Body& vessel : {Made(Mug{}), Made(Bowl{}), Made(Tray{})}) {
    const auto grains = FillVessel(vessel, kRadius_m, 100, 1);
    EXPECT_EQ(grains.size(), 100u);
    ExpectLoose(vessel, grains);
  }
}

TEST(FillVessel, AThinWallHoldsThemHoweverTheyLie) {
  const Body glass = Made(Mug{.radius_m = 0.05, .height_m = 0.15, .wall_m = 0.002}),
             mug = Made(Mug{.radius_m = 0.05, .height_m = 0.15}),
             tray = Made(Tray{.wall_m = 0.001});
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    for (const auto& [vessel, radius_m] :
         {std::pair(&glass, 0.004), std::pair(&mug, 0.008), std::pair(&tray, 0.008)}) {
      const auto grains = FillVessel(*vessel, radius_m, 100, seed);
      EXPECT_EQ(grains.size(), 100u) << seed << ", " << radius_m;
      ExpectLoose(*vessel, grains, radius_m);
    }
  }
}

TEST(FillVessel, NoneIsInTheHandleOrOutside) {
  const Mug mug{.radius_m = 0.04, .height_m = 0.1, .wall_m = 0.005, .handle_m = 0.05};
  const auto grains = FillVessel(Made(mug), kRadius_m, 500, 1);
  for (const Eigen::Vector3d& grain : grains)
    EXPECT_LT(grain.head<2>().norm(), 0.035 - kRadius_m + 1e-4);
}

TEST(FillVessel, AFullOneTakesNoMore) {
  const auto grains = FillVessel(Made(Mug{}), kRadius_m, 500, 1);
  EXPECT_GT(grains.size(), 200u);  // 365 ml, packed to more than a third
  EXPECT_LT(grains.size(), 500u);
  for (const Eigen::Vector3d& grain : grains) EXPECT_LT(grain.z(), 0.05);
}

TEST(FillVessel, WhatHasNoHollowTakesNone) {
  const Body board{.name = "board", .shapes = {{Box{{0.3, 0.3, 0.02}}, {}}}};
  EXPECT_TRUE(FillVessel(board, kRadius_m, 10, 1).empty());
  const Body pipe{.name = "pipe",
                  .shapes = {{Box{{0.01, 0.1, 0.1}}, {{0.05, 0, 0}}},
                             {Box{{0.01, 0.1, 0.1}}, {{-0.05, 0, 0}}}}};
  EXPECT_TRUE(FillVessel(pipe, kRadius_m, 10, 1).empty());
  EXPECT_TRUE(FillVessel(Made(Shelf{}), 0.02, 500, 1).empty());  // it leaks
}

TEST(FillVessel, TheSeedDecides) {
  const Body mug = Made(Mug{});
  EXPECT_EQ(FillVessel(mug, kRadius_m, 50, 7), FillVessel(mug, kRadius_m, 50, 7));
  EXPECT_NE(FillVessel(mug, kRadius_m, 50, 7), FillVessel(mug, kRadius_m, 50, 8));
}

}  // namespace
}  // namespace prehend::physics
