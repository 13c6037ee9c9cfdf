// SPDX-License-Identifier: Apache-2.0
// The engines behind their border: bodies, contacts, and a hand that holds its target.
#include "physics/world/world.h"

#include <gtest/gtest.h>

#include "physics/box2d/world.h"
#include "physics/bullet/world.h"
#include "tests/physics/library_hand.h"

namespace prehend::physics {
namespace {

Body Floor() {
  return {
      .name = "floor", .shapes = {{Box{{2, 2, 0.1}}, {}}}, .fixed = true, .X_WB = {{0, 0, -0.05}}};
}

Snapshot After(World& world, int ticks, const std::vector<HandCommand>& commands = {}) {
  Snapshot snapshot;
  for (int i = 0; i < ticks; ++i) {
    world.Step(commands);
    world.Describe(snapshot);
  }
  return snapshot;
}

std::vector<ContactPoint> PointsOf(const Snapshot& snapshot) {
  std::vector<ContactPoint> points;
  for (const auto& part : snapshot.AllContacts())
    points.insert(points.end(), part.begin(), part.end());
  return points;
}

/// What holds in every engine; all of it happens in a plane.
class WorldTest : public testing::TestWithParam<Engine> {
 protected:
  static std::unique_ptr<World> Make(Scene scene, const std::vector<int>& styles = {}) {
    scene.world.planar = GetParam() == Engine::kBox2d;
    return scene.world.planar ? MakeBox2dWorld(scene, styles) : MakeBulletWorld(scene, styles);
  }
};

INSTANTIATE_TEST_SUITE_P(Worlds, WorldTest, testing::Values(Engine::kBullet, Engine::kBox2d),
                         [](const auto& engine) {
                           return engine.param == Engine::kBox2d ? "box2d" : "bullet";
                         });

TEST_P(WorldTest, EveryShapeRestsAtItsOwnHeight) {
  const std::pair<Shape, double> cases[] = {{Box{{0.1, 0.1, 0.2}}, 0.1},
                                            {Sphere{0.05}, 0.05},
                                            {Cylinder{0.05, 0.1}, 0.05},
                                            {Capsule{0.05, 0.1}, 0.1}};
  for (const auto& [shape, height] : cases) {
    const Scene scene{.bodies = {Floor(),
                                 {.name = "thing",
                                  .shapes = {{shape, {}}},
                                  .mass_kg = 0.5,
                                  .X_WB = {{0, 0, height + 0.01}}}}};
    const auto world = Make(scene);
    const Snapshot snapshot = After(*world, 240);
    EXPECT_NEAR(snapshot.bodies[1].X_WB.p_m.z(), height, 0.0005);
    const std::vector<ContactPoint> points = PointsOf(snapshot);
    ASSERT_FALSE(points.empty());
    EXPECT_EQ(points[0].a.body, BodyIndex(0));
    EXPECT_EQ(points[0].b.body, BodyIndex(1));
    // From the thing (b) into the floor (a): down.
    EXPECT_LT(points[0].nhat_BA_W.z(), -0.99);
  }
}

TEST_P(WorldTest, ContactsCarryTheWeight) {
  const Scene scene{.bodies = {Floor(),
                               {.name = "thing",
                                .shapes = {{Box{{0.1, 0.1, 0.1}}, {}}},
                                .mass_kg = 2,
                                .X_WB = {{0, 0, 0.05}}}}};
  const auto world = Make(scene);
  double impulse = 0;
  for (const ContactPoint& contact : PointsOf(After(*world, 240)))
    impulse += contact.normal_impulse_n_s;
  EXPECT_NEAR(impulse * 480, 2 * 9.81, 0.2);
}

TEST_P(WorldTest, TouchingNeedsAPush) {
  // Side by side, nothing presses them together.
  const auto block = [](const char* name, double x) {
    return Body{
        .name = name, .shapes = {{Box{{0.1, 0.1, 0.1}}, {}}}, .mass_kg = 1, .X_WB = {{x, 0, 0.05}}};
  };
  const auto world = Make({.bodies = {Floor(), block("left", 0), block("right", 0.101)}});
  for (const ContactPoint& contact : PointsOf(After(*world, 240)))
    EXPECT_EQ(contact.a.body, BodyIndex(0));
}

TEST_P(WorldTest, ARestingContactNeverFlickers) {
  const Scene scene{.bodies = {Floor(),
                               {.name = "can",
                                .shapes = {{Cylinder{0.033, 0.12}, {}}},
                                .mass_kg = 0.3,
                                .X_WB = {{0, 0, 0.06}}}}};
  const auto world = Make(scene);
  After(*world, 48);
  for (int i = 0; i < 1500; ++i) ASSERT_FALSE(PointsOf(After(*world, 1)).empty()) << i;
  EXPECT_TRUE(After(*world, 1).bodies[1].asleep);
}

TEST_P(WorldTest, WhatSleepsIsTheSameFromTickToTickUntilItIsWoken) {
  // A can stands on the floor; a ball falls on it when it has long been asleep.
  const Scene scene{
      .bodies = {
          Floor(),
          {.name = "can",
           .shapes = {{Box{{0.06, 0.06, 0.12}}, {}}},
           .mass_kg = 0.3,
           .X_WB = {{0, 0, 0.06}}},
          {.name = "ball", .shapes = {{Sphere{0.03}, {}}}, .mass_kg = 0.3, .X_WB = {{0, 0, 60}}}}};
  const auto world = Make(scene);
  Snapshot snapshot = After(*world, 1200);
  ASSERT_TRUE(snapshot.bodies[1].asleep);
  EXPECT_FALSE(snapshot.MayHaveMoved(1, 1199));
  EXPECT_TRUE(snapshot.MayHaveMoved(2, 1199));
  EXPECT_FALSE(snapshot.MayHaveMoved(0, 1)) << "what is fixed never moves";
  const auto resting = snapshot.resting;
  ASSERT_TRUE(resting);
  EXPECT_TRUE(snapshot.contacts.empty());
  while (true) {
    EXPECT_EQ(snapshot.resting, resting);
    const BodyState before = snapshot.bodies[1];
    world->Step({});
    world->Describe(snapshot);
    ASSERT_LT(snapshot.tick, 3000);
    if (!snapshot.bodies[1].asleep) break;
    ASSERT_EQ(snapshot.bodies[1].X_WB.p_m, before.X_WB.p_m);
  }
  EXPECT_TRUE(snapshot.MayHaveMoved(1, snapshot.tick - 1));
  EXPECT_EQ(snapshot.resting, nullptr);
  EXPECT_FALSE(snapshot.contacts.empty());
  // A snapshot that begins now says the same as one that was kept.
  const Snapshot fresh = [&] {
    Snapshot s;
    world->Describe(s);
    return s;
  }();
  for (std::size_t i = 0; i < fresh.bodies.size(); ++i)
    EXPECT_EQ(fresh.bodies[i].X_WB.p_m, snapshot.bodies[i].X_WB.p_m);
}

TEST_P(WorldTest, ACompoundTurnsAboutItsCentreOfMass) {
  // A dumb-bell whose frame B is in one of its ends: in free fall the ends' middle falls straight.
  const Body bell{.name = "bell",
                  .shapes = {{Sphere{0.05}, {}}, {Sphere{0.05}, {{0.4, 0, 0}}}},
                  .mass_kg = 1,
                  .X_WB = {{0, 0, 5}}};
  const Scene scene{.bodies = {bell}};
  const auto world = Make(scene);
  const BodyState state = After(*world, 240).bodies[0];
  EXPECT_NEAR((state.X_WB * Eigen::Vector3d(0.2, 0, 0)).x(), 0.2, 1e-6);
  EXPECT_NEAR((state.X_WB * Eigen::Vector3d(0.2, 0, 0)).z(), 5 - 9.81 / 8, 0.01);
}

TEST_P(WorldTest, AHandHoversAtItsTarget) {
  const bool planar = GetParam() == Engine::kBox2d;
  const HandModel model = LibraryHand(planar ? "planar_gripper" : "human_right");
  const Eigen::Vector3d axis = planar ? Eigen::Vector3d(0, 1, 0) : Eigen::Vector3d(1, 2, 3);
  const Pose X_WH{{0, 0, 1}, Eigen::Quaterniond(Eigen::AngleAxisd(0.7, axis.normalized()))};
  const auto world = Make({.hands = {{"hand", model, X_WH}}}, {0});
  const Snapshot snapshot =
      After(*world, 480, {{.target = {.X_WH = X_WH, .trigger = 1}, .style = 0}});
  const HandState& hand = snapshot.hands[0];
  EXPECT_LT((hand.palm.X_WB.p_m - X_WH.p_m).norm(), 0.001);
  EXPECT_LT(hand.palm.X_WB.q.angularDistance(X_WH.q), 0.01);
  const std::vector<double> wanted = JointTargets(model.styles[0], 1);
  for (std::size_t i = 0; i < wanted.size(); ++i)
    EXPECT_NEAR(hand.joints[i], wanted[i], model.links[i].slides ? 0.001 : 0.02)
        << model.links[i].name;
  // What the engine says and what our own kinematics says is the same.
  const std::vector<Pose> X_HL = LinkPoses(model, hand.joints);
  for (std::size_t i = 0; i < X_HL.size(); ++i)
    EXPECT_LT((hand.X_WL[i].p_m - (hand.palm.X_WB * X_HL[i]).p_m).norm(), 0.001)
        << model.links[i].name;
}

/// How late a hand's first joint follows a trigger that rises by 1 in 2 s.
double LateBy_s(bool planar, int rate_hz) {
  const HandModel model = LibraryHand(planar ? "planar_gripper" : "human_right");
  Scene scene{.hands = {{"hand", model, {{0, 0, 1}}}}};
  scene.world.rate_hz = rate_hz;
  scene.world.planar = planar;
  const auto world = planar ? MakeBox2dWorld(scene, {0}) : MakeBulletWorld(scene, {0});
  HandCommand command{.target = {.X_WH = {{0, 0, 1}}}};
  const std::vector<double> open = JointTargets(model.styles[0], 0);
  const std::vector<double> half = JointTargets(model.styles[0], 0.5);
  Snapshot snapshot;
  for (int tick = 1; tick <= rate_hz; ++tick) {
    command.target.trigger = tick / (2.0 * rate_hz);
    world->Step({command});
  }
  world->Describe(snapshot);
  return (half[0] - snapshot.hands[0].joints[0]) / (half[0] - open[0]);
}

// A tick more or less is no cause: in it the joint already follows.
TEST_P(WorldTest, JointsFollowAlikeInShorterTicks) {
  const bool planar = GetParam() == Engine::kBox2d;
  const double late_s = LateBy_s(planar, 480);
  EXPECT_NEAR(late_s, 0.010, 0.003);
  for (const int rate_hz : {960, 1920})
    EXPECT_NEAR(LateBy_s(planar, rate_hz), late_s, 0.002) << rate_hz;
}

/// How far a palm that has pressed on a part of a body is drawn away when the two do not touch any
/// more.
double ApartAt_m(double yaw_deg) {
  const Pose turn{.q = FromRollPitchYaw({0, 0, yaw_deg})};
  const HandModel model = LibraryHand("human_right");
  constexpr int kHook = 6;  // the thumb is out of the way
  const Pose X_WH{{0, 0, 1 + model.palm_size_m.z() / 2}};
  const Body bench{
      .name = "bench",
      .shapes = {{Box{{0.05, 0.05, 0.02}}, {}}, {Box{{0.05, 0.05, 0.02}}, {.p_m = {0, 0, -0.3}}}},
      .fixed = true,
      .X_WB = turn * Pose{{0, 0, 0.99}}};
  const auto world =
      MakeBulletWorld({.bodies = {bench}, .hands = {{"hand", model, turn * X_WH}}}, {kHook});
  Snapshot snapshot;
  constexpr int kPressed = 100, kMost = 1000;
  constexpr double kDrawn_m_per_s = 0.005;
  for (int tick = 1 - kPressed; tick < kMost; ++tick) {
    HandCommand command{.target = {.X_WH = turn * X_WH}, .style = kHook};
    command.target.X_WH.p_m.z() += kDrawn_m_per_s * std::max(tick, 0) / 480 - 0.001;
    if (tick > 0) command.target.v_m_per_s.z() = kDrawn_m_per_s;
    world->Step({command});
    world->Describe(snapshot);
    const bool touch = !PointsOf(snapshot).empty();
    EXPECT_TRUE(touch || tick != 0);
    if (tick > 0 && !touch) return snapshot.hands[0].palm.X_WB.p_m.z() - X_WH.p_m.z();
  }
  return 0;
}

// Bullet drops the points of a part when bounding boxes along the axes of the world part.
TEST(BulletWorld, WhatHasPressedOnAPartTouchesItUntilHalfAMillimetreAway) {
  for (const double yaw_deg : {0.0, 37.0, 90.0})
    EXPECT_NEAR(ApartAt_m(yaw_deg), 0.0005, 0.0001) << yaw_deg;
}

}  // namespace
}  // namespace prehend::physics
