// SPDX-License-Identifier: Apache-2.0
// What lies on something that tips over starts to slide where friction says, though it lay still
// before: physics/bullet/core/dispatcher.h.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "physics/box2d/world.h"
#include "physics/bullet/world.h"
#include "physics/scene/hull.h"

namespace prehend::physics {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kEnd_rad = 40 * kDegree;

/// Every pair of shapes has its own way of finding points.
using Shapes = std::vector<PlacedShape>;

Shapes Block() { return {{Box{{0.06, 0.06, 0.06}}, {}}}; }
Shapes TwoBlocks() {
  return {{Box{{0.03, 0.06, 0.06}}, {{-0.015, 0, 0}}}, {Box{{0.03, 0.06, 0.06}}, {{0.015, 0, 0}}}};
}
Shapes Can() { return {{Cylinder{0.03, 0.06}, {}}}; }
Shapes Cut() {
  std::vector<Eigen::Vector3d> corners_m;
  for (const double x : {-0.03, 0.03})
    for (const double y : {-0.03, 0.03})
      for (const double z : {-0.03, 0.03}) corners_m.emplace_back(x, y, z);
  return {{*MakeHull(corners_m).hull, {}}};
}
Shapes Board() { return {{Box{{0.6, 0.1, 0.02}}, {}}}; }
Shapes TwoBoards() {
  return {{Box{{0.3, 0.1, 0.02}}, {{-0.15, 0, 0}}}, {Box{{0.3, 0.1, 0.02}}, {{0.15, 0, 0}}}};
}

/// A board on a damped hinge, which tips by 40 degrees in 3 s with what lies on it.
Scene MakeScene(const Shapes& board, const Shapes& thing, double friction, Engine engine) {
  Scene scene;
  scene.bodies = {
      {.name = "post",
       .shapes = {{Box{{0.05, 0.1, 0.2}}, {}}},
       .fixed = true,
       .X_WB = {{0, 0, 0.8}}},
      {.name = "board", .shapes = board, .mass_kg = 1, .friction = 1, .X_WB = {{0, 0, 1}}},
      {.name = "thing",
       .shapes = thing,
       .mass_kg = 0.5,
       .friction = friction,
       .X_WB = {{0.1, 0, 1.04}}}};
  scene.joints = {{.kind = JointKind::kHinge,
                   .body = BodyIndex(1),
                   .base = BodyIndex(0),
                   .pivot_W_m = {0, 0, 1},
                   .axis_W = Eigen::Vector3d::UnitY(),
                   .lower = -kEnd_rad,
                   .upper = kEnd_rad,
                   .damping = 2}};
  scene.world.planar = engine == Engine::kBox2d;
  return scene;
}

/// Tilt of the board at which the thing has begun to slide; the end if it does not.
double SlidesAt_rad(const Scene& scene) {
  const auto world = scene.world.planar ? MakeBox2dWorld(scene, {}) : MakeBulletWorld(scene, {});
  Snapshot now;
  double start_m = 0;
  for (int i = 0; i < 3 * scene.world.rate_hz; ++i) {
    world->Step({});
    world->Describe(now);
    const double at_m = (now.bodies[1].X_WB.inverse() * now.bodies[2].X_WB).p_m.x();
    if (i == 60) start_m = at_m;  // it lies still
    if (i > 60 && at_m - start_m > 0.0001) break;
  }
  return now.joints[0].position;
}

class TippingTest : public testing::TestWithParam<Engine> {};

INSTANTIATE_TEST_SUITE_P(Worlds, TippingTest, testing::Values(Engine::kBullet, Engine::kBox2d),
                         [](const auto& engine) {
                           return engine.param == Engine::kBox2d ? "box2d" : "bullet";
                         });

TEST_P(TippingTest, WhatLiesOnABoardSlidesAboveTheFrictionAngle) {
  std::vector<Shapes> things = {Block(), TwoBlocks(), Can()};
  if (GetParam() == Engine::kBullet) things.push_back(Cut());  // no hulls in the plane
  for (const Shapes& board : {Board(), TwoBoards()})
    for (const Shapes& thing : things)
      for (const double friction : {0.2, 0.64}) {
        const double tilt_rad = SlidesAt_rad(MakeScene(board, thing, friction, GetParam()));
        EXPECT_NEAR(tilt_rad / kDegree, std::atan(friction) / kDegree, 1.5)
            << "shape " << thing[0].shape.index() << " of " << thing.size() << " on "
            << board.size();
      }
}

}  // namespace
}  // namespace prehend::physics
