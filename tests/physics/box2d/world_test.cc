// SPDX-License-Identifier: Apache-2.0
// What is Box2D's own: what it lacks and was given, tasks of the gripper, determinism, runs that go
// wrong. What every engine does is in tests/physics/world/world_test.cc and
// tests/physics/scene/joint_test.cc.
#include "physics/box2d/world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "physics/simulation.h"
#include "tests/physics/library_hand.h"

namespace prehend::physics {
namespace {

constexpr int kTable = 0, kObject = 1;

struct Setting {
  Engine engine = Engine::kBox2d;
  Shape shape = Box{{0.06, 0.06, 0.10}};
  double height_m = 0.10;
  double mass_kg = 0.3;
  double friction = 0.8;
  double at_m = -0.1;
  double offset_m = 0;  ///< of the reach
};

Scene GripperScene(const Setting& setting) {
  Scene scene;
  scene.world.engine = setting.engine;
  scene.world.planar = true;
  scene.bodies.push_back({.name = "table",
                          .shapes = {{Box{{1.6, 0.8, 0.04}}, {}}},
                          .fixed = true,
                          .X_WB = {{0, 0, 0.74}}});
  scene.bodies.push_back({.name = "object",
                          .shapes = {{setting.shape, {}}},
                          .mass_kg = setting.mass_kg,
                          .friction = setting.friction,
                          .X_WB = {{setting.at_m, 0, 0.76 + setting.height_m / 2}}});
  scene.hands.push_back({"gripper", LibraryHand("planar_gripper"), {{-0.3, 0, 1.1}}});
  return scene;
}

Script PickAndPlace(double offset_m) {
  Script script;
  const auto add = [&](StepAction action, double over_s) {
    script.stages.push_back({{{HandIndex(0), std::move(action), over_s}}});
  };
  add(ReachStep{"object", "parallel", Approach::kAuto, {offset_m, 0, 0}}, 0.8);
  add(TriggerStep{1}, 0.6);
  add(WaitStep{}, 0.2);
  add(MoveStep{{0, 0, 0.25}}, 0.6);
  add(CarryStep{{0.4, 0}}, 1.0);
  add(PlaceStep{"table"}, 0.6);
  add(TriggerStep{0}, 0.45);
  add(RetreatStep{0.2}, 0.6);
  return script;
}

struct Outcome {
  RunStatus status;
  double rise_m = 0;
  double miss_m = 0;
  double height_m = 0;  ///< at the end, above the start
  double tilt_rad = 0;
  double off_plane_m = 0;  ///< largest |y| of anything
  std::uint64_t hash = 0;

  bool Placed() const {
    return status.kind == RunStatus::Kind::kCompleted && rise_m > 0.2 && miss_m < 0.05 &&
           std::abs(height_m) < 0.003 && tilt_rad < 0.17;
  }
};

std::ostream& operator<<(std::ostream& out, const Outcome& o) {
  return out << "rise " << o.rise_m << " m, miss " << o.miss_m << " m, height " << o.height_m
             << " m, tilt " << o.tilt_rad << ", off the plane " << o.off_plane_m << " m "
             << o.status.reason;
}

Outcome Perform(const Setting& setting) {
  Simulation simulation(GripperScene(setting), PickAndPlace(setting.offset_m));
  const Pose start = simulation.snapshot().bodies[kObject].X_WB;
  Outcome outcome;
  while (simulation.Step()) {
    const Snapshot& now = simulation.snapshot();
    const Eigen::Vector3d& p = now.bodies[kObject].X_WB.p_m;
    outcome.rise_m = std::max(outcome.rise_m, p.z() - start.p_m.z());
    outcome.off_plane_m =
        std::max({outcome.off_plane_m, std::abs(p.y()), std::abs(now.hands[0].palm.X_WB.p_m.y())});
  }
  const Pose& end = simulation.snapshot().bodies[kObject].X_WB;
  outcome.status = simulation.status();
  outcome.miss_m = std::abs(end.p_m.x() - 0.4);
  outcome.height_m = end.p_m.z() - start.p_m.z();
  outcome.tilt_rad = end.q.angularDistance(start.q);
  outcome.hash = simulation.state_hash();
  return outcome;
}

TEST(Box2dTest, TheGripperPlacesInBothEngines) {
  for (const Engine engine : {Engine::kBox2d, Engine::kBullet}) {
    const Outcome outcome = Perform({.engine = engine});
    EXPECT_TRUE(outcome.Placed()) << outcome;
    EXPECT_LT(outcome.off_plane_m, engine == Engine::kBox2d ? 1e-12 : 1e-3) << outcome;
  }
}

TEST(Box2dTest, PlacesFortyOfFortyVariations) {
  std::mt19937_64 generator(1);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(generator() >> 11) * 0x1p-53;
  };
  for (int trial = 0; trial < 40; ++trial) {
    const double height = 0.10 * between(0.9, 1.1);
    const Setting setting{.shape = Box{{0.06 * between(0.9, 1.1), 0.06, height}},
                          .height_m = height,
                          .mass_kg = between(0.2, 0.5),
                          .friction = between(0.7, 0.9),
                          .at_m = -0.1 + between(-0.008, 0.008),
                          .offset_m = between(-0.008, 0.008)};
    const Outcome outcome = Perform(setting);
    EXPECT_TRUE(outcome.Placed()) << "trial " << trial << ": " << outcome << " size "
                                  << std::get<Box>(setting.shape).size_m.transpose() << " mass "
                                  << setting.mass_kg << " at " << setting.at_m << " offset "
                                  << setting.offset_m;
  }
}

TEST(Box2dTest, OnlyFrictionHolds) {
  const Outcome slippery = Perform({.friction = 0.02});
  EXPECT_EQ(slippery.status.kind, RunStatus::Kind::kCompleted) << slippery;
  EXPECT_LT(slippery.rise_m, 0.05) << slippery;
  EXPECT_LT(Perform({.mass_kg = 6}).rise_m, 0.02);
}

TEST(Box2dTest, RunsAreTheSameBitByBitWhateverRunsBeside) {
  const std::uint64_t hash = Perform({}).hash;
  EXPECT_EQ(Perform({}).hash, hash);
  EXPECT_NE(Perform({.mass_kg = 0.31}).hash, hash);

  Simulation other(GripperScene({.mass_kg = 0.5}), PickAndPlace(0));
  Simulation simulation(GripperScene({}), PickAndPlace(0));
  while (simulation.Step()) other.Step();
  EXPECT_EQ(simulation.state_hash(), hash);
}

/// A body alone above or on a floor, whose top is at 0.
Simulation Alone(Body body, double seconds) {
  Scene scene{.bodies = {{.name = "floor",
                          .shapes = {{Box{{10, 1, 0.1}}, {}}},
                          .fixed = true,
                          .friction = 1,
                          .restitution = 1,
                          .X_WB = {{0, 0, -0.05}}},
                         std::move(body)}};
  scene.world.engine = Engine::kBox2d;
  scene.world.planar = true;
  return Simulation(scene, {.settle_s = seconds});
}

Body Ball(double height_m) {
  return {.name = "ball", .shapes = {{Sphere{0.05}, {}}}, .mass_kg = 1, .X_WB = {{0, 0, height_m}}};
}

TEST(Box2dTest, RestitutionIsMultiplied) {
  Body ball = Ball(0.55);
  ball.restitution = 0.5;
  Simulation simulation = Alone(ball, 1);
  double lowest = 1, rebound = 0;
  while (simulation.Step()) {
    const double z = simulation.snapshot().bodies[1].X_WB.p_m.z();
    lowest = std::min(lowest, z);
    if (lowest < 0.06) rebound = std::max(rebound, z - 0.05);
  }
  EXPECT_NEAR(rebound, 0.25 * 0.5, 0.01);
}

TEST(Box2dTest, AnInclineIsLeftAboveTheFrictionAngle) {
  for (const double slope : {0.9, 1.1}) {  // shares of the tangent at which it starts to slide
    Scene scene{
        .bodies = {
            {.name = "ramp", .shapes = {{Box{{4, 1, 0.1}}, {}}}, .fixed = true, .friction = 0.8},
            {.name = "block",
             .shapes = {{Box{{0.2, 0.1, 0.05}}, {}}},
             .mass_kg = 1,
             .friction = 0.5}}};
    const Eigen::Quaterniond tilt(
        Eigen::AngleAxisd(std::atan(0.4 * slope), Eigen::Vector3d::UnitY()));
    scene.bodies[0].X_WB.q = tilt;
    scene.bodies[1].X_WB = {tilt * Eigen::Vector3d(0, 0, 0.075), tilt};
    scene.world.engine = Engine::kBox2d;
    scene.world.planar = true;
    Simulation simulation(scene, {.settle_s = 1});
    while (simulation.Step()) {
    }
    const double way = simulation.snapshot().bodies[1].X_WB.p_m.x();
    if (slope < 1)
      EXPECT_LT(std::abs(way - (tilt * Eigen::Vector3d(0, 0, 0.075)).x()), 0.002);
    else
      EXPECT_GT(way, 0.1);
  }
}

TEST(Box2dTest, RollingFrictionStopsABall) {
  for (const double rolling : {0.0, 0.002}) {
    Body ball = Ball(0.05);
    ball.friction = 1;
    ball.rolling_friction = rolling;
    // A ramp sets it going.
    Scene scene = Alone(ball, 0).scene();
    scene.bodies[1].X_WB.p_m = {-1, 0, 0.2};
    scene.bodies.push_back(
        {.name = "ramp",
         .shapes = {{Box{{0.6, 0.2, 0.02}},
                     {Eigen::Vector3d::Zero(),
                      Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()))}}},
         .fixed = true,
         .friction = 1,
         .X_WB = {{-0.9, 0, 0.09}}});
    Simulation simulation(scene, {.settle_s = 6});
    while (simulation.Step()) {
    }
    const BodyState& end = simulation.snapshot().bodies[1];
    EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kCompleted);
    if (rolling > 0) {
      EXPECT_LT(end.v_WB_m_per_s.norm(), 0.01);
      EXPECT_GT(end.X_WB.p_m.x(), -0.5);
    } else {
      EXPECT_GT(end.v_WB_m_per_s.norm(), 0.3);
      EXPECT_NEAR(end.w_WB_rad_per_s.y(), end.v_WB_m_per_s.x() / 0.05, 0.5) << "it rolls";
    }
  }
}

TEST(Box2dTest, WhatLeavesTheWorldEndsTheRun) {
  Body ball = Ball(0.2);
  ball.X_WB.p_m.x() = 8;  // beside the floor
  Simulation simulation = Alone(ball, 10);
  while (simulation.Step()) {
  }
  EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kFailed);
  EXPECT_EQ(simulation.status().entity, "ball");
  EXPECT_GT(simulation.status().tick, 480);
  EXPECT_NE(simulation.status().reason.find("from the origin"), std::string::npos);
}

TEST(Box2dTest, WhatIsTooFastEndsTheRun) {
  Scene scene{.bodies = {Ball(0)}};
  scene.world = {.engine = Engine::kBox2d, .planar = true, .gravity_m_per_s2 = 1000};
  Simulation simulation(scene, {.settle_s = 1});
  while (simulation.Step()) {
  }
  EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kFailed);
  EXPECT_EQ(simulation.status().entity, "ball");
  EXPECT_EQ(simulation.status().reason.substr(0, 12), "it moves at ");
  EXPECT_FALSE(simulation.status().advice.empty());
}

TEST(Box2dTest, AFingerOfHingesClosesToItsTargets) {
  HandModel model = LibraryHand("planar_gripper");
  for (HandLink& link : model.links) {
    const double side = link.name == "post" ? 1 : -1;
    link.slides = false;
    link.joint_axis = {0, -side, 0};  // positive angles close
    link.strength = 1;
    link.lower = -0.5;
    link.upper = 0.5;
  }
  model.styles[0].frames = {{-0.2, -0.2}, {0.3, 0.3}};
  Scene scene;
  scene.world.planar = true;
  scene.hands = {{"hand", model, {{0, 0, 1}}}};
  const auto world = MakeBox2dWorld(scene, {0});
  Snapshot now;
  world->Describe(now);
  EXPECT_NEAR(now.hands[0].joints[0], -0.2, 1e-6);
  for (int i = 0; i < 240; ++i)
    world->Step({{.target = {.X_WH = {{0, 0, 1}}, .trigger = 1}, .style = 0}});
  world->Describe(now);
  const HandState& hand = now.hands[0];
  const std::vector<Pose> X_HL = LinkPoses(model, hand.joints);
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    EXPECT_NEAR(hand.joints[i], 0.3, 0.01);
    EXPECT_LT((hand.X_WL[i].p_m - (hand.palm.X_WB * X_HL[i]).p_m).norm(), 0.001);
    EXPECT_LT(hand.X_WL[i].q.angularDistance((hand.palm.X_WB * X_HL[i]).q), 0.01);
  }
}

}  // namespace
}  // namespace prehend::physics
