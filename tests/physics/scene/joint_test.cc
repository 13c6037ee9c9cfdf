// SPDX-License-Identifier: Apache-2.0
// Joints between bodies: what they leave free, where they stop, and what resists. Bodies with a
// fixed joint are one, but are touched apart.
#include "physics/scene/joint.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "physics/scene/snapshot.h"
#include "physics/simulation.h"

namespace prehend::physics {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

Body Frame() {
  return {
      .name = "frame", .shapes = {{Box{{0.1, 0.1, 0.1}}, {}}}, .fixed = true, .X_WB = {{0, 0, 1}}};
}

Body Block(const Vector3d& at_m, double mass_kg = 2) {
  return {
      .name = "block", .shapes = {{Box{{0.2, 0.1, 0.1}}, {}}}, .mass_kg = mass_kg, .X_WB = {at_m}};
}

/// A slider along the vertical: gravity is the load.
Scene Lift(Joint joint) {
  joint.kind = JointKind::kSlider;
  joint.body = BodyIndex(1);
  joint.axis_W = -Vector3d::UnitZ();
  return {.bodies = {Frame(), Block({0, 0, 0.9})}, .joints = {joint}};
}

/// A hinge about y at the frame: the block, 0.3 m beside it, falls.
Scene Flap(Joint joint) {
  joint.kind = JointKind::kHinge;
  joint.body = BodyIndex(1);
  joint.axis_W = Vector3d::UnitY();
  joint.pivot_W_m = {0, 0, 1};
  return {.bodies = {Frame(), Block({0.3, 0, 1})}, .joints = {joint}};
}

/// What holds in every engine; all of it happens in a plane.
class JointInEveryEngine : public testing::TestWithParam<Engine> {
 protected:
  static Snapshot After(Scene scene, double seconds) {
    scene.world.engine = GetParam();
    scene.world.planar = GetParam() == Engine::kBox2d;
    Simulation simulation(scene, {.settle_s = seconds});
    while (simulation.Step()) {
    }
    EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kCompleted) << simulation.status().reason;
    return simulation.snapshot();
  }
};

INSTANTIATE_TEST_SUITE_P(Joints, JointInEveryEngine,
                         testing::Values(Engine::kBullet, Engine::kBox2d), [](const auto& engine) {
                           return engine.param == Engine::kBox2d ? "box2d" : "bullet";
                         });

TEST_P(JointInEveryEngine, ASliderFallsToItsLimitAndNowhereElse) {
  const Snapshot end = After(Lift({.upper = 0.3}), 1);
  EXPECT_NEAR(end.joints[0].position, 0.3, 0.001);
  EXPECT_NEAR(end.joints[0].fraction, 1, 0.004);
  EXPECT_NEAR(end.bodies[1].X_WB.p_m.z(), 0.6, 0.001);
  EXPECT_LT(end.bodies[1].X_WB.p_m.head<2>().norm(), 1e-4);
  EXPECT_LT(end.bodies[1].X_WB.q.vec().norm(), 1e-4);
}

TEST_P(JointInEveryEngine, AHingeTurnsThePositiveWayToItsLimit) {
  const Snapshot end = After(Flap({.lower = -0.2, .upper = 0.8}), 2);
  EXPECT_NEAR(end.joints[0].position, 0.8, 0.005);
  EXPECT_NEAR(end.bodies[1].X_WB.p_m.x(), 0.3 * std::cos(0.8), 0.003);
  EXPECT_NEAR(end.bodies[1].X_WB.p_m.z(), 1 - 0.3 * std::sin(0.8), 0.003);
}

TEST_P(JointInEveryEngine, AHingeStopsAtItsLowerLimit) {
  Scene scene = Flap({.lower = -0.4, .upper = 0});
  scene.joints[0].axis_W = -Vector3d::UnitY();
  const Snapshot end = After(scene, 2);
  EXPECT_NEAR(end.joints[0].position, -0.4, 0.005);
  EXPECT_NEAR(end.joints[0].fraction, 0, 0.01);
}

TEST_P(JointInEveryEngine, FrictionHoldsUpToItsSize) {
  const double weight_n = 2 * 9.81;
  EXPECT_NEAR(After(Lift({.upper = 0.3, .friction = 1.1 * weight_n}), 1).joints[0].position, 0,
              0.001);
  EXPECT_GT(After(Lift({.upper = 0.3, .friction = 0.9 * weight_n}), 1).joints[0].position, 0.2);
  const double torque_nm = 0.3 * weight_n;
  EXPECT_NEAR(After(Flap({.upper = 1, .friction = 1.3 * torque_nm}), 1).joints[0].position, 0,
              0.01);
  EXPECT_GT(After(Flap({.upper = 1, .friction = 0.7 * torque_nm}), 1).joints[0].position, 0.1);
}

TEST_P(JointInEveryEngine, DampingSetsTheSpeedOfAFall) {
  // Weight and damping balance at m g / d.
  const Snapshot slider = After(Lift({.upper = 2, .damping = 100}), 1);
  EXPECT_NEAR(slider.bodies[1].v_WB_m_per_s.z(), -2 * 9.81 / 100, 0.002);
}

TEST_P(JointInEveryEngine, ASpringCarriesTheWeight) {
  const Snapshot slider =
      After(Lift({.lower = -0.3, .upper = 0.3, .damping = 20, .spring = 200}), 4);
  EXPECT_NEAR(slider.joints[0].position, 2 * 9.81 / 200, 0.002);
  const Snapshot pulled =
      After(Lift({.lower = -0.3, .upper = 0.3, .damping = 20, .spring = 200, .rest = -0.1}), 4);
  EXPECT_NEAR(pulled.joints[0].position, 2 * 9.81 / 200 - 0.1, 0.002);
  // The flap hangs where spring and weight agree: k a = m g l cos a.
  const Snapshot flap = After(Flap({.lower = -1, .upper = 1, .damping = 0.5, .spring = 15}), 4);
  const double a = flap.joints[0].position;
  EXPECT_NEAR(15 * a, 2 * 9.81 * 0.3 * std::cos(a), 0.1);
}

TEST(JointTest, ABallJointSwingsAnyWayAboutItsPivot) {
  const Joint joint{.kind = JointKind::kBall, .body = BodyIndex(1), .pivot_W_m = {0, 0, 1}};
  const Scene scene{.bodies = {Frame(), Block({0.2, 0.2, 1})}, .joints = {joint}};
  Simulation simulation(scene, {.settle_s = 2});
  double lowest = 1;
  while (simulation.Step()) {
    const Vector3d& p = simulation.snapshot().bodies[1].X_WB.p_m;
    EXPECT_NEAR((p - Vector3d(0, 0, 1)).norm(), 0.2 * std::sqrt(2), 0.004);
    lowest = std::min(lowest, p.z());
  }
  EXPECT_NEAR(lowest, 1 - 0.2 * std::sqrt(2), 0.01);
}

TEST_P(JointInEveryEngine, FixedJointsMakeOneBodyThatIsTouchedApart) {
  // A plate with a peg below it: the peg touches the floor, the plate does not.
  const Scene scene{
      .bodies = {{.name = "floor", .shapes = {{Box{{2, 2, 0.1}}, {}}}, .fixed = true},
                 {.name = "plate",
                  .shapes = {{Box{{0.2, 0.2, 0.02}}, {}}},
                  .mass_kg = 1,
                  .X_WB = {{0, 0, 0.21}}},
                 {.name = "peg",
                  .shapes = {{Box{{0.1, 0.1, 0.1}}, {}}},
                  .mass_kg = 0.5,
                  .X_WB = {{0, 0, 0.15}}}},
      .joints = {{.kind = JointKind::kFixed, .body = BodyIndex(2), .base = BodyIndex(1)}}};
  const Snapshot end = After(scene, 1);
  EXPECT_NEAR(end.bodies[2].X_WB.p_m.z(), 0.10, 0.001);
  EXPECT_NEAR((end.bodies[1].X_WB.p_m - end.bodies[2].X_WB.p_m).z(), 0.06, 1e-9);
  double impulse = 0;
  for (const auto& points : end.AllContacts()) {
    for (const ContactPoint& contact : points) {
      EXPECT_EQ(contact.a.body, BodyIndex(0));
      EXPECT_EQ(contact.b.body, BodyIndex(2));
      impulse += contact.normal_impulse_n_s;
    }
  }
  EXPECT_NEAR(impulse * 480, 1.5 * 9.81, 0.2);
}

TEST_P(JointInEveryEngine, BodiesOfAJointDoNotTouchEachOther) {
  const Snapshot end = After(Lift({.upper = 0.3, .friction = 100}), 0.2);
  for (const auto& points : end.AllContacts()) EXPECT_TRUE(points.empty());
}

TEST(JointTest, TheWayAlongAHingeIsAnArcAboutItsPivot) {
  const Scene scene = Flap({.upper = 2});
  const Pose moved =
      MotionAlong(scene, scene.joints[0], scene.bodies[0].X_WB, kPi / 2) * scene.bodies[1].X_WB;
  EXPECT_LT((moved.p_m - Vector3d(0, 0, 0.7)).norm(), 1e-12);
  EXPECT_NEAR(StateOf(scene, scene.joints[0], scene.bodies[0].X_WB, moved).position, kPi / 2,
              1e-12);
  // A base that has moved takes the way with it.
  const Pose carried{{1, 2, 3}, Eigen::Quaterniond(Eigen::AngleAxisd(1, Vector3d::UnitX()))};
  const Pose X_WBase = carried * scene.bodies[0].X_WB;
  const Pose there =
      MotionAlong(scene, scene.joints[0], X_WBase, 0.5) * carried * scene.bodies[1].X_WB;
  EXPECT_NEAR(StateOf(scene, scene.joints[0], X_WBase, there).position, 0.5, 1e-12);
}

TEST(JointTest, AHandleIsMovedByTheJointOfWhatItIsFixedTo) {
  Scene scene = Flap({.upper = 1});
  scene.bodies.push_back(Block({0.4, 0, 1}));
  scene.bodies.push_back(Block({2, 0, 1}));
  scene.joints.push_back({.kind = JointKind::kFixed, .body = BodyIndex(2), .base = BodyIndex(1)});
  EXPECT_EQ(RootOf(scene, BodyIndex(2)), BodyIndex(1));
  EXPECT_EQ(JointThatMoves(scene, BodyIndex(2)), 0);
  EXPECT_EQ(JointThatMoves(scene, BodyIndex(3)), -1);
  EXPECT_TRUE(MovesFreely(scene, BodyIndex(3)));
  for (const int body : {0, 1, 2}) EXPECT_FALSE(MovesFreely(scene, BodyIndex(body))) << body;
}

TEST_P(JointInEveryEngine, DampedBodiesSlowDown) {
  Body block = Block({0, 0, 10});
  block.linear_damping_per_s = 5;
  // Weight and damping balance at g / c.
  EXPECT_NEAR(After({.bodies = {block}}, 2).bodies[0].v_WB_m_per_s.z(), -9.81 / 5, 0.02);
}

}  // namespace
}  // namespace prehend::physics
