// SPDX-License-Identifier: Apache-2.0
// Springs and damping of joints against closed forms, for bodies of 2 cm to 1 m, in both engines.
#include "physics/world/joint_spring.h"

#include <gtest/gtest.h>

#include <cmath>

#include "physics/box2d/world.h"
#include "physics/bullet/world.h"

namespace prehend::physics {
namespace {

using Eigen::Vector3d;

constexpr double kOneTick_s = 1.0 / 480;
constexpr double kFall_m_per_s2 = 9.81;

class JointSpringTest : public testing::TestWithParam<Engine> {
 protected:
  static std::unique_ptr<World> MakeWorld(Scene scene) {
    scene.world.planar = true;
    return GetParam() == Engine::kBox2d ? MakeBox2dWorld(scene, {}) : MakeBulletWorld(scene, {});
  }
  /// The joint's position after every tick, until `end_s`.
  static std::vector<double> Positions(const Scene& scene, double end_s) {
    const auto world = MakeWorld(scene);
    std::vector<double> positions;
    Snapshot snapshot;
    while (snapshot.tick < end_s / kOneTick_s) {
      world->Step({});
      world->Describe(snapshot);
      positions.push_back(snapshot.joints[0].position);
    }
    return positions;
  }
};

INSTANTIATE_TEST_SUITE_P(Worlds, JointSpringTest, testing::Values(Engine::kBullet, Engine::kBox2d),
                         [](const auto& engine) {
                           return engine.param == Engine::kBox2d ? "box2d" : "bullet";
                         });

Body Cube(double size_m, double mass_kg, const Vector3d& at_m) {
  return {.name = "cube",
          .shapes = {{Box{Vector3d::Constant(size_m)}, {}}},
          .mass_kg = mass_kg,
          .X_WB = {at_m}};
}

Body Post() {
  return {
      .name = "post", .shapes = {{Box{{0.1, 0.1, 0.1}}, {}}}, .fixed = true, .X_WB = {{-2, 0, 1}}};
}

/// Of cubes on a slider whose spring pulls them 0.05 m along the axis.
Scene Sprung(double size_m, double mass_kg, double spring, const Vector3d& axis_W) {
  const Joint joint{.kind = JointKind::kSlider,
                    .body = BodyIndex(1),
                    .axis_W = axis_W,
                    .lower = -0.5,
                    .upper = 0.5,
                    .spring = spring,
                    .rest = 0.05};
  return {.bodies = {Post(), Cube(size_m, mass_kg, {0, 0, 2})}, .joints = {joint}};
}

/// It swings about `rest` with this frequency, starting from 0, within 1 % of the way, and half a
/// tick early or late.
void ExpectSwing(const std::vector<double>& positions, double rest, double rad_per_s) {
  const double late = rad_per_s * kOneTick_s;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double phase = rad_per_s * kOneTick_s * static_cast<double>(i + 1);
    ASSERT_NEAR(positions[i], rest * (1 - std::cos(phase)), rest * (0.01 + late / 2)) << i;
  }
}

TEST_P(JointSpringTest, ASliderSwingsAsItsMassSaysAndNotItsSize) {
  for (const double size_m : {0.02, 0.06, 0.3, 1.0})
    for (const double mass_kg : {0.1, 1.0})
      for (const double rad_per_s : {5.0, 20.0}) {
        SCOPED_TRACE(testing::Message() << size_m << ' ' << mass_kg << ' ' << rad_per_s);
        const Scene scene =
            Sprung(size_m, mass_kg, mass_kg * rad_per_s * rad_per_s, Vector3d::UnitX());
        ExpectSwing(Positions(scene, 1), 0.05, rad_per_s);
      }
}

TEST_P(JointSpringTest, ASliderRestsWhereSpringAndWeightAgree) {
  for (const Vector3d& axis_W : {Vector3d(0, 0, 1), Vector3d(0, 0, -1), Vector3d(0.6, 0, -0.8)})
    for (const double size_m : {0.02, 1.0}) {
      Scene scene = Sprung(size_m, 0.5, 50, axis_W);
      scene.joints[0].damping = 2 * std::sqrt(0.5 * 50);  // critical
      const double sag_m = -axis_W.z() * 0.5 * kFall_m_per_s2 / 50;
      EXPECT_NEAR(Positions(scene, 1.5).back(), 0.05 + sag_m, 0.01 * std::abs(sag_m));
    }
}

TEST_P(JointSpringTest, ASpringDoesNotPushAJointOutOfItsRange) {
  for (const double size_m : {0.02, 0.06, 0.4}) {
    Scene scene = Sprung(size_m, 1, 100, Vector3d::UnitX());
    scene.joints[0].upper = 0.1;
    scene.joints[0].rest = 0.5;
    for (const double position : Positions(scene, 0.5)) ASSERT_LT(position, 0.1 + 0.001);
    EXPECT_NEAR(Positions(scene, 0.5).back(), 0.1, 0.001);
  }
}

TEST_P(JointSpringTest, AHingeSwingsAsItsMomentSays) {
  for (const double size_m : {0.02, 0.3, 1.0}) {
    const double arm_m = size_m, mass_kg = 2;
    const double moment = mass_kg * (size_m * size_m / 6 + arm_m * arm_m);
    for (const double way : {1.0, -1.0}) {
      Scene scene = Sprung(size_m, mass_kg, moment * 100, way * Vector3d::UnitY());
      scene.joints[0].kind = JointKind::kHinge;
      scene.joints[0].pivot_W_m = {-arm_m, 0, 2};
      scene.world.gravity_m_per_s2 = 0;
      ExpectSwing(Positions(scene, 1), 0.05, 10);
    }
  }
}

TEST_P(JointSpringTest, TwoThatAreFreeSwingAsTheirReducedMassSays) {
  Scene scene = Sprung(0.1, 1, 100, Vector3d::UnitX());
  scene.world.gravity_m_per_s2 = 0;
  scene.bodies[0] = Cube(0.1, 3, {-0.4, 0, 2});
  ExpectSwing(Positions(scene, 1), 0.05, std::sqrt(100 / 0.75));
}

TEST_P(JointSpringTest, WhatIsTooStiffForATickDoesNotExplode) {
  Scene scene = Sprung(0.02, 0.01, 1e6, Vector3d::UnitX());
  scene.joints[0].damping = 1e4;
  for (const double position : Positions(scene, 0.2)) ASSERT_LT(std::abs(position), 0.11);
  EXPECT_NEAR(Positions(scene, 0.2).back(), 0.05, 1e-4);
}

TEST_P(JointSpringTest, JointsThatShareABodyDoNotReadEachOthersPush) {
  // A cube that hangs on a cube, damped: each rests where its own spring bears the weight below.
  const Vector3d down = -Vector3d::UnitZ();
  Scene scene = Sprung(0.1, 1, 400, down);
  scene.bodies.push_back(Cube(0.1, 1, {0, 0, 1.5}));
  Joint lower = scene.joints[0];
  lower.body = BodyIndex(2);
  lower.base = BodyIndex(1);
  lower.spring = 100;
  for (Joint* joint : {&lower, &scene.joints[0]}) {
    joint->damping = 20;
    joint->rest = 0;
  }
  scene.joints.insert(scene.joints.begin(), lower);
  EXPECT_NEAR(Positions(scene, 4).back(), kFall_m_per_s2 / 100, 0.001);
  std::swap(scene.joints[0], scene.joints[1]);
  EXPECT_NEAR(Positions(scene, 4).back(), 2 * kFall_m_per_s2 / 400, 0.001);
}

TEST_P(JointSpringTest, ManyThatPullAtALightBodyDoNotExplode) {
  // All in a row, so that nothing turns.
  Scene scene = Sprung(0.1, 1, 500, Vector3d::UnitX());
  scene.world.gravity_m_per_s2 = 0;
  scene.joints[0].damping = 1000;
  scene.bodies = {Cube(0.1, 0.2, {0, 0, 2})};
  const Joint joint = scene.joints[0];
  scene.joints.clear();
  for (int more = 1; more <= 3; ++more) {
    scene.bodies.push_back(Cube(0.1, 1, {0.5 * more, 0, 2}));
    scene.joints.push_back(joint);
    scene.joints.back().body = BodyIndex(more);
  }
  const std::vector<double> positions = Positions(scene, 1);
  for (const double position : positions) ASSERT_LT(std::abs(position), 0.0515);
  EXPECT_NEAR(positions.back(), 0.05, 0.0005);
}

TEST_P(JointSpringTest, WhatCreepsHomeDoesNotFallAsleepOnItsWay) {
  Scene scene = Sprung(0.1, 1, 20, Vector3d::UnitX());
  scene.joints[0].damping = 100;
  scene.joints[0].rest = 0.1;
  EXPECT_NEAR(Positions(scene, 12).back(), 0.1 * (1 - std::exp(-12 * 20 / 100.0)), 0.001);
}

TEST(JointSpringLawTest, ATooStiffSpringHasTheInertiaThatTheJointLeavesItToMove) {
  // Two equal cubes on a slider, one beside the other: they turn while they part. By hand:
  // 1 / inertia = 2 / m + d^2 / 2I.
  const double moment = 2.0 / 600, apart_m = 0.3;
  const JointSide base{.per_mass = 0.5, .per_moment_W = Eigen::Matrix3d::Identity() / moment};
  JointSide body = base;
  body.centre_W_m = {0, 0, apart_m};
  const double inertia = 1 / (1 + apart_m * apart_m / (2 * moment));
  const Joint joint{.kind = JointKind::kSlider, .spring = 1e9, .rest = 1};
  const JointPlace place{0, Vector3d::UnitX(), {0, 0, 0}};
  EXPECT_NEAR(SpringForce(joint, place, 1, base, body, kOneTick_s) * kOneTick_s * kOneTick_s,
              inertia, 1e-9);
}

}  // namespace
}  // namespace prehend::physics
