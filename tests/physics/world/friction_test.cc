// SPDX-License-Identifier: Apache-2.0
// Friction has no preferred direction: what slides or rolls down a slope does so at the same angle,
// whichever way the slope faces. The closed forms are Coulomb's.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "physics/bullet/world.h"

namespace prehend::physics {
namespace {

constexpr double kDegreeInRad = std::numbers::pi / 180;
constexpr double kBoardFriction = 0.8;

/// `thing` lies on a board that slopes by `slope_deg` towards `yaw_deg`.
Scene Slope(const Shape& thing, double height_m, double slope_deg, double yaw_deg) {
  const Eigen::Quaterniond turn(
      Eigen::AngleAxisd(yaw_deg * kDegreeInRad, Eigen::Vector3d::UnitZ()) *
      Eigen::AngleAxisd(slope_deg * kDegreeInRad, Eigen::Vector3d::UnitY()));
  const Eigen::Vector3d board_W_m(0, 0, 1);
  Scene scene;
  scene.bodies = {{.name = "board",
                   .shapes = {{Box{{2, 2, 0.02}}, {}}},
                   .fixed = true,
                   .friction = kBoardFriction,
                   .X_WB = {board_W_m, turn}},
                  {.name = "thing",
                   .shapes = {{thing, {}}},
                   .mass_kg = 0.5,
                   .friction = 0.5,
                   .rolling_friction = std::holds_alternative<Sphere>(thing) ? 0.006 : 0,
                   .X_WB = {board_W_m + turn * Eigen::Vector3d(0, 0, 0.01 + height_m), turn}}};
  return scene;
}

/// How far the thing moves in two seconds.
double Moved_m(const Scene& scene) {
  const auto world = MakeBulletWorld(scene, {});
  Snapshot now;
  for (int i = 0; i < 2 * scene.world.rate_hz; ++i) world->Step({});
  world->Describe(now);
  return (now.bodies[1].X_WB.p_m - scene.bodies[1].X_WB.p_m).norm();
}

constexpr double kYaws_deg[] = {0, 15, 30, 45, 90, 200};

TEST(Friction, ABlockSlidesAboveTheSameAngleInEveryDirection) {
  const double limit_deg = std::atan(0.5 * kBoardFriction) / kDegreeInRad;  // 21.8
  for (const double yaw_deg : kYaws_deg) {
    const auto moved_m = [&](double share) {
      return Moved_m(Slope(Box{{0.06, 0.06, 0.02}}, 0.01, share * limit_deg, yaw_deg));
    };
    EXPECT_LT(moved_m(0.97), 0.002) << "yaw " << yaw_deg;
    EXPECT_GT(moved_m(1.03), 0.05) << "yaw " << yaw_deg;
  }
}

TEST(Friction, ACapsuleRollsAsSolidsDo) {
  const Eigen::Quaterniond slope(Eigen::AngleAxisd(0.25, Eigen::Vector3d::UnitY()));
  const Eigen::Quaterniond lying(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX()));
  const Body floor{.name = "floor",
                   .shapes = {{Box{{9, 2, 0.1}}, {}}},
                   .fixed = true,
                   .friction = 1,
                   .X_WB = {slope * Eigen::Vector3d(0, 0, -0.05), slope}};
  const Body roller{.name = "roller",
                    .shapes = {{Capsule{0.1, 0.2}, {}}},
                    .mass_kg = 1,
                    .friction = 1,
                    .X_WB = {slope * Eigen::Vector3d(0, 0, 0.1), slope * lying}};
  const auto world = MakeBulletWorld(Scene{.bodies = {floor, roller}}, {});
  for (int tick = 0; tick < 480; ++tick) world->Step({});
  Snapshot snapshot;
  world->Describe(snapshot);
  // 0.6 of the mass is a cylinder, 0.4 a ball: their moments of inertia in units of m r^2.
  const double moment = 0.6 * 0.5 + 0.4 * 0.4;
  EXPECT_NEAR(snapshot.bodies[1].v_WB_m_per_s.norm(), 9.81 * std::sin(0.25) / (1 + moment), 0.03);
}

TEST(Friction, ABallRollsAboveTheSameAngleInEveryDirection) {
  const double radius_m = 0.03;
  const double limit_deg = std::atan(0.006 * kBoardFriction / radius_m) / kDegreeInRad;  // 9.1
  for (const double yaw_deg : kYaws_deg) {
    const auto moved_m = [&](double share) {
      return Moved_m(Slope(Sphere{radius_m}, radius_m, share * limit_deg, yaw_deg));
    };
    EXPECT_LT(moved_m(0.97), 0.002) << "yaw " << yaw_deg;
    EXPECT_GT(moved_m(1.03), 0.05) << "yaw " << yaw_deg;
  }
}

TEST(Friction, ASlidingBlockSlidesStraightDownAsFarAsCoulombSays) {
  const double slope = 30 * kDegreeInRad, mu = 0.5 * kBoardFriction, time_s = 1;
  const double far_m =
      0.5 * 9.81 * (std::sin(slope) - mu * std::cos(slope)) * time_s * time_s;  // 0.75
  for (const double yaw_deg : kYaws_deg) {
    const Scene scene = Slope(Box{{0.2, 0.2, 0.02}}, 0.01, 30, yaw_deg);
    const auto world = MakeBulletWorld(scene, {});
    for (int i = 0; i < time_s * scene.world.rate_hz; ++i) world->Step({});
    Snapshot now;
    world->Describe(now);
    const Pose& board = scene.bodies[0].X_WB;
    const Eigen::Vector3d moved_m =
        board.q.conjugate() * (now.bodies[1].X_WB.p_m - scene.bodies[1].X_WB.p_m);
    EXPECT_NEAR(moved_m.x(), far_m, 0.01 * far_m) << "yaw " << yaw_deg;
    EXPECT_NEAR(moved_m.y(), 0, 0.002) << "yaw " << yaw_deg;
  }
}

}  // namespace
}  // namespace prehend::physics
