// SPDX-License-Identifier: Apache-2.0
// Steps that end when something happens, turn, go around or press.
#include <gtest/gtest.h>

#include <numeric>

#include "physics/hand/hand_clearance.h"
#include "physics/hand/script_player.h"
#include "tests/physics/tabletop.h"

namespace prehend::physics {
namespace {

Step Guarded(StepAction action, double over_s, Until until) {
  return {.hand = HandIndex(0),
          .action = std::move(action),
          .over_s = over_s,
          .until = std::move(until)};
}

struct Played {
  Simulation simulation;
  Played(const Scene& scene, Script script) : simulation(scene, std::move(script)) {
    while (simulation.Step()) {
    }
  }
};

TEST(GuardedMotion, EndsWhenTheHandTouches) {
  const Scene scene = MakeScene({.hand_at_m = {-0.3, -0.2, 1.0}});
  Script script;
  script.stages = {{{Guarded(MoveStep{{0, 0, -0.4}}, 4, {.thing = "table"})}},
                   {{{HandIndex(0), MoveStep{{0, 0, 0.05}}, 0.5}}}};
  script.settle_s = 0.3;
  const Played played(scene, script);
  EXPECT_EQ(played.simulation.status().kind, RunStatus::Kind::kCompleted)
      << played.simulation.status().reason;
  EXPECT_LT(played.simulation.snapshot().tick, 480 * 4) << "shorter than planned";
  const Snapshot& now = played.simulation.snapshot();
  const HandClearance clearance(scene, HandIndex(0), now.hands[0].joints);
  EXPECT_NEAR(clearance.To(BodyIndex(kTable), now.hands[0].palm.X_WB, now), 0.05, 0.01)
      << "it goes up from where it was stopped";
}

TEST(GuardedMotion, WhatNeverHappensFailsOrGoesOn) {
  const Scene scene = MakeScene({.hand_at_m = {-0.3, -0.2, 1.2}});
  Script script;
  script.stages = {{{Guarded(MoveStep{{0, 0, -0.05}}, 0.5, {.thing = "table"})}}};
  script.stages[0].steps[0].written_at = "a.yaml:3:5";
  const Played failed(scene, script);
  EXPECT_EQ(failed.simulation.status().kind, RunStatus::Kind::kFailed);
  EXPECT_EQ(failed.simulation.status().reason,
            "a.yaml:3:5: until: the step is over, and 'hand' has not touched 'table': it is more "
            "than 100 mm away from it");
  script.stages[0].steps[0].until->or_go_on = true;
  EXPECT_EQ(Played(scene, script).simulation.status().kind, RunStatus::Kind::kCompleted);
}

/// The object falls onto the table from a height.
Scene Falling(double height_m) {
  Scene scene = MakeScene({.hand_at_m = {-0.3, -0.2, 1.2}});
  scene.bodies[kObject].X_WB.p_m.z() += height_m;
  return scene;
}

TEST(GuardedMotion, AHandOrAPersonWaitsForOthers) {
  for (const double height_m : {0.1, 0.5, 1.2}) {
    const Scene scene = Falling(height_m);
    const Until until{.thing = "table", .gap_m = {}, .or_go_on = false, .who = "object"};
    Script of_hand{.stages = {{{Guarded(WaitStep{}, 3, until)}}}, .settle_s = 0};
    const double falls_s = std::sqrt(2 * height_m / 9.81);
    EXPECT_NEAR(static_cast<double>(Played(scene, of_hand).simulation.snapshot().tick) / 480,
                falls_s, 0.005)
        << height_m;
    Scene with_anna = scene;
    Person anna{.name = "anna", .head = BodyIndex(scene.bodies.size()), .X_WS = {{-2, 0, 0}}};
    Body head{.name = "anna", .kinematic = true};
    head.shapes.push_back({Capsule{0.05, 0.03}, {}});
    head.X_WB.p_m = {-2, 0, 1.6};
    with_anna.bodies.push_back(head);
    with_anna.persons.push_back(anna);
    PersonStep wait{.person = 0, .action = WaitStep{}, .over_s = 3, .until = until};
    Script of_anna{.stages = {{.steps = {}, .person_steps = {wait}}}, .settle_s = 0};
    EXPECT_NEAR(static_cast<double>(Played(with_anna, of_anna).simulation.snapshot().tick) / 480,
                falls_s, 0.005);
    // Too short a time for it.
    of_anna.stages[0].person_steps[0].over_s = falls_s / 2;
    const Played failed(with_anna, of_anna);
    EXPECT_EQ(failed.simulation.status().reason,
              "until: the step of anna is over, and 'object' has not touched 'table'");
    EXPECT_NEAR(static_cast<double>(failed.simulation.snapshot().tick) / 480, falls_s / 2, 0.005);
    of_anna.stages[0].person_steps[0].until->or_go_on = true;
    EXPECT_EQ(Played(with_anna, of_anna).simulation.status().kind, RunStatus::Kind::kCompleted);
    of_hand.stages[0].steps[0].over_s = falls_s / 2;
    EXPECT_EQ(Played(scene, of_hand).simulation.status().reason,
              "until: the step is over, and 'object' has not touched 'table'");
  }
}

TEST(GuardedMotion, AHandWaitsForAnotherHand) {
  for (const bool by_gap : {true, false}) {
    Scene scene = MakeScene({.hand_at_m = {-0.3, -0.2, 1.0}});
    scene.hands.push_back({"other", LibraryHand("human_right"), {{-0.3, 0.3, 1.4}}});
    Until until{.thing = "table", .gap_m = {}, .or_go_on = false, .who = "hand"};
    if (by_gap) until.gap_m = 0.03;
    Step wait = Guarded(WaitStep{}, 5, until);
    wait.hand = HandIndex(1);
    Step down{HandIndex(0), MoveStep{{0, 0, -0.35}}, 4};
    Step up{HandIndex(1), MoveStep{{0, 0, 0.1}}, 0.1};
    Script script{.stages = {{{down, wait, up}}}, .settle_s = 0};
    Simulation simulation(scene, script);
    while (simulation.Step() && simulation.snapshot().hands[1].X_WTarget.p_m.z() < 1.41) {
    }
    const Snapshot& now = simulation.snapshot();
    const HandClearance clearance(scene, HandIndex(0), now.hands[0].joints);
    EXPECT_NEAR(clearance.To(BodyIndex(kTable), now.hands[0].palm.X_WB, now), by_gap ? 0.03 : 0,
                0.01)
        << "the other goes up when it is there";
  }
}

TEST(GuardedMotion, StopsAtAGap) {
  const Scene scene = MakeScene({.hand_at_m = {-0.3, -0.2, 1.0}});
  Script script;
  script.stages = {{{Guarded(MoveStep{{0, 0, -0.3}}, 6, {.thing = "table", .gap_m = 0.02})}}};
  script.settle_s = 0.5;
  const Played played(scene, script);
  const Snapshot& now = played.simulation.snapshot();
  const HandClearance clearance(scene, HandIndex(0), now.hands[0].joints);
  EXPECT_NEAR(clearance.To(BodyIndex(kTable), now.hands[0].palm.X_WB, now), 0.02, 0.003);
}

TEST(GuardedMotion, AFastHandBrakesBeforeItsGap) {
  // 0.35 m in a second: 0.66 m/s in the middle.
  const Scene scene = MakeScene({.hand_at_m = {-0.3, -0.2, 1.05}});
  Script script;
  script.stages = {{{Guarded(MoveStep{{0, 0, -0.35}}, 1, {.thing = "table", .gap_m = 0.005})}}};
  script.settle_s = 0.5;
  Simulation simulation(scene, script);
  double least_m = 1;
  while (simulation.Step()) {
    const Snapshot& now = simulation.snapshot();
    const HandClearance clearance(scene, HandIndex(0), now.hands[0].joints);
    least_m = std::min(least_m, clearance.To(BodyIndex(kTable), now.hands[0].palm.X_WB, now));
  }
  EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kCompleted) << simulation.status().reason;
  EXPECT_NEAR(least_m, 0.005, 0.0015);
}

TEST(GuardedMotion, AHeldThingTouchesToo) {
  const Scene scene = MakeScene({});
  Script script = MakeScript({});
  script.stages.resize(3);  // reached, closed, lifted by 25 cm
  script.stages.push_back({{Guarded(MoveStep{{0, 0, -0.4}}, 4, {.thing = "table"})}});
  script.settle_s = 0.3;
  const Played played(scene, script);
  ASSERT_EQ(played.simulation.status().kind, RunStatus::Kind::kCompleted);
  EXPECT_NEAR(played.simulation.snapshot().bodies[kObject].X_WB.p_m.z(), kTop_m + 0.1, 0.005);
}

/// The target at the end of one step, in a world that does not move.
Pose EndOf(const Scene& scene, StepAction action) {
  Simulation still(scene, {});
  ScriptPlayer player(scene,
                      {.stages = {{{{HandIndex(0), std::move(action), 1}}}}, .settle_s = 0.1});
  Pose last;
  while (const auto* commands = player.Advance(still.snapshot()))
    last = commands->front().target.X_WH;
  EXPECT_EQ(player.problem(), "");
  return last;
}

TEST(GuardedMotion, AnOrbitEndsAtItsAngleAndDistance) {
  const Scene scene = MakeScene({});  // the object stands at (0.2, 0.1)
  const Pose begin = scene.hands[0].X_WH;
  const Pose end = EndOf(scene, OrbitStep{"object", M_PI / 2, 0.3});
  const Eigen::Vector2d centre(0.2, 0.1), from = begin.p_m.head<2>() - centre,
                                          to = end.p_m.head<2>() - centre;
  EXPECT_NEAR(to.norm(), 0.3, 1e-9);
  EXPECT_NEAR(from.normalized().dot(to.normalized()), 0, 1e-9);
  EXPECT_GT(from.x() * to.y() - from.y() * to.x(), 0) << "counter-clockwise";
  EXPECT_NEAR(end.p_m.z(), begin.p_m.z(), 1e-12);
  EXPECT_NEAR(end.q.angularDistance(begin.q), M_PI / 2, 1e-9) << "the hand turns with it";
}

/// A hand that is turned to the left, beside an object that is turned by half a turn.
Scene TurnedScene() {
  Scene scene = MakeScene({.yaw_rad = M_PI});
  scene.hands[0].X_WH.q = Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  return scene;
}

PosesStep OneWaypoint(const Eigen::Vector3d& at_m, PoseFrame frame) {
  return {.poses = {{.t_s = 0.5, .X_WH = {at_m}, .trigger = {}}}, .frames = {std::move(frame)}};
}

TEST(GuardedMotion, WayPointsAreRelativeToTheHandOrToAThing) {
  const Scene scene = TurnedScene();
  const Pose& hand = scene.hands[0].X_WH;
  const Pose& object = scene.bodies[kObject].X_WB;
  const Eigen::Vector3d ahead(0.1, 0, 0.02);
  const Pose own = EndOf(scene, OneWaypoint(ahead, {.own_hand = true}));
  EXPECT_TRUE(own.p_m.isApprox(hand.p_m + Eigen::Vector3d(0, 0.1, 0.02), 1e-9)) << own.p_m;
  EXPECT_LT(own.q.angularDistance(hand.q), 1e-6);
  const Pose along_world = EndOf(scene, OneWaypoint(ahead, {.own_hand = true, .world_axes = true}));
  EXPECT_TRUE(along_world.p_m.isApprox(hand.p_m + ahead, 1e-9)) << along_world.p_m;
  EXPECT_LT(along_world.q.angularDistance(hand.q), 1e-6);
  const Pose at_object = EndOf(scene, OneWaypoint(ahead, {.name = "object"}));
  EXPECT_TRUE(at_object.p_m.isApprox(object.p_m + Eigen::Vector3d(-0.1, 0, 0.02), 1e-9));
  EXPECT_LT(at_object.q.angularDistance(object.q), 1e-6);
  const Pose beside = EndOf(scene, OneWaypoint(ahead, {.name = "object", .world_axes = true}));
  EXPECT_TRUE(beside.p_m.isApprox(object.p_m + ahead, 1e-9));
  EXPECT_LT(beside.q.angularDistance(Eigen::Quaterniond::Identity()), 1e-6);
  Scene two = TurnedScene();
  two.hands.push_back({"other", LibraryHand("human_left"), {{0.3, 0.5, 1.1}}});
  const Pose at_other = EndOf(two, OneWaypoint(ahead, {.name = "other"}));
  EXPECT_TRUE(at_other.p_m.isApprox(Eigen::Vector3d(0.4, 0.5, 1.12), 1e-3)) << at_other.p_m;
}

TEST(GuardedMotion, ATurnIsAboutTheWorldsAxesOrTheHands) {
  Scene scene = MakeScene({});
  scene.hands[0].X_WH.q = Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX()));
  const Eigen::Quaterniond quarter(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  const Pose world = EndOf(scene, TurnHandStep{{0, 0, M_PI / 2}}),
             own = EndOf(scene, TurnHandStep{{0, 0, M_PI / 2}, true});
  EXPECT_LT(world.q.angularDistance(quarter * scene.hands[0].X_WH.q), 1e-6);
  EXPECT_LT(own.q.angularDistance(scene.hands[0].X_WH.q * quarter), 1e-6);
  const Pose around = EndOf(scene, TurnHandStep{{0, 0, 2 * M_PI}});
  EXPECT_LT(around.q.angularDistance(scene.hands[0].X_WH.q), 1e-6) << "a whole turn";
}

TEST(GuardedMotion, PressesWithTheForceThatIsAsked) {
  const Scene scene = MakeScene({.hand_at_m = {-0.3, -0.2, 0.9}});
  Script script;
  script.stages = {{{Guarded(MoveStep{{0, 0, -0.3}}, 2, {.thing = "table"})}},
                   {{{HandIndex(0), PressStep{"table", 10}, 1.5}}}};
  script.settle_s = 0;
  Simulation simulation(scene, script);
  std::vector<double> force_n;
  while (simulation.Step()) {
    double impulse_n_s = 0;
    for (const ContactPoint& contact : simulation.snapshot().contacts)
      if (contact.a.hand == HandIndex(0) || contact.b.hand == HandIndex(0))
        impulse_n_s += contact.normal_impulse_n_s;
    force_n.push_back(impulse_n_s * scene.world.rate_hz);
  }
  ASSERT_GT(force_n.size(), 480u);
  EXPECT_NEAR(std::accumulate(force_n.end() - 240, force_n.end(), 0.0) / 240, 10, 1.5);
}

}  // namespace
}  // namespace prehend::physics
