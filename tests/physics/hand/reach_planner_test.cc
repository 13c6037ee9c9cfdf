// SPDX-License-Identifier: Apache-2.0
#include "physics/hand/reach_planner.h"

#include <gtest/gtest.h>

#include <numbers>
#include <utility>

#include "physics/person/skeleton.h"
#include "tests/physics/tabletop.h"

namespace prehend::physics {
namespace {

using Eigen::Vector3d;

ReachPlan Plan(const Scene& scene, const std::string& style, Approach approach,
               Vector3d offset_m = Vector3d::Zero()) {
  Simulation simulation(scene, {});
  return PlanReach(scene, simulation.snapshot(),
                   {.hand = HandIndex(0),
                    .object = BodyIndex(kObject),
                    .style = FindStyle(scene.hands[0].model, style),
                    .approach = approach,
                    .offset_m = offset_m,
                    .from = {.X_WH = scene.hands[0].X_WH}});
}

TEST(ReachPlannerTest, ArrivesAlongTheApproachWithThePalmTowardsTheObject) {
  const Scene scene = MakeScene({});
  const ReachPlan above = Plan(scene, "wrap", Approach::kAbove);
  EXPECT_LT((above.toward_W + Vector3d::UnitZ()).norm(), 1e-9);
  EXPECT_GT(above.segment.curve_m[3].z(), kTop_m + 0.2);

  const ReachPlan side = Plan(scene, "wrap", Approach::kSide);
  EXPECT_NEAR(side.toward_W.z(), 0, 1e-9);
  EXPECT_LT((side.segment.q_end * -Vector3d::UnitZ() - side.toward_W).norm(), 1e-9);
  EXPECT_NEAR(side.segment.curve_m[3].z(), kTop_m + 0.1, 0.01);
  // From where the hand starts, not around the object.
  EXPECT_GT(side.toward_W.dot(Vector3d(0.4, 0.3, 0)), 0);
}

TEST(ReachPlannerTest, AutoTakesTallThingsFromTheSideAndLowOnesFromAbove) {
  EXPECT_NEAR(Plan(MakeScene({}), "wrap", Approach::kAuto).toward_W.z(), 0, 1e-9);
  const Scene low = MakeScene({.shape = Box{{0.06, 0.06, 0.06}}});
  EXPECT_NEAR(Plan(low, "wrap", Approach::kAuto).toward_W.z(), -1, 1e-9);
}

TEST(ReachPlannerTest, ThePlanTurnsWithTheHandAndTheThing) {
  const auto plan = [](double yaw_rad, const Vector3d& size_m, Approach approach) {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()));
    Scene scene = MakeScene({.shape = Box{size_m}, .yaw_rad = yaw_rad});
    scene.bodies[kTable].shapes = {{Box{{4, 4, 0.04}}, {}}};
    const Vector3d centre_m = scene.bodies[kObject].X_WB.p_m;
    scene.hands[0].X_WH = {centre_m + turn * Vector3d(-0.4, 0, 0.4), turn};
    return Eigen::Quaterniond(turn.conjugate() * Plan(scene, "pinch", approach).segment.q_end);
  };
  // A slab, of which the bounds along the world's axes are as wide as it is high at some yaws; and
  // a bar, for which the hand rolls by a right angle one way or the other.
  const Vector3d slab_m(0.037, 0.21, 0.165), bar_m(0.014, 0.16, 0.014);
  for (const auto& [size_m, approach] :
       {std::pair(slab_m, Approach::kAuto), std::pair(bar_m, Approach::kSide)}) {
    const Eigen::Quaterniond straight = plan(0, size_m, approach);
    for (double yaw = 0.1; yaw < 6.2; yaw += 0.7)
      EXPECT_LT(plan(yaw, size_m, approach).angularDistance(straight), 1e-5)
          << size_m.z() << ' ' << yaw;
  }
}

TEST(ReachPlannerTest, TheGripIsSquareToATurnedBox) {
  for (const double yaw : {0.3, 1.0, -0.6}) {
    const Scene scene = MakeScene({.yaw_rad = yaw});
    const ReachPlan plan = Plan(scene, "wrap", Approach::kAbove);
    const Vector3d grip = plan.segment.q_end * Vector3d::UnitX();
    const double relative =
        std::remainder(std::atan2(grip.y(), grip.x()) - yaw, std::numbers::pi / 2);
    EXPECT_NEAR(relative, 0, 1e-9) << yaw;
  }
}

TEST(ReachPlannerTest, OfTwoEqualTurnsAHandTakesTheOneInward) {
  // From the half between two faces both are 45 degrees away.
  for (const std::string hand : {"human_right", "human_left"}) {
    Scene scene = MakeScene({.shape = Box{{0.06, 0.06, 0.06}}, .hand = hand});
    Eigen::Quaterniond& from = scene.hands[0].X_WH.q;
    for (const double yaw : {0.25, 0.75, -0.25, -0.75}) {
      from = Eigen::AngleAxisd(yaw * std::numbers::pi, Vector3d::UnitZ());
      const ReachPlan plan = Plan(scene, "wrap", Approach::kAbove);
      const Eigen::AngleAxisd turn(plan.segment.q_end * from.conjugate());
      EXPECT_NEAR(turn.angle(), std::numbers::pi / 4, 1e-9) << hand << yaw;
      EXPECT_NEAR(turn.axis().z(), hand == "human_right" ? 1 : -1, 1e-9) << hand << yaw;
    }
  }
}

TEST(ReachPlannerTest, ALongBoxIsGrippedAcross) {
  const Scene scene = MakeScene({.shape = Box{{0.15, 0.06, 0.06}}});
  const ReachPlan plan = Plan(scene, "wrap", Approach::kAbove);
  EXPECT_NEAR(std::abs((plan.segment.q_end * Vector3d::UnitX()).y()), 1, 1e-9);
}

TEST(ReachPlannerTest, TheWayIsClearFromManySidesAndEndsWithTheHandOverTheTable) {
  for (double angle = 0; angle < 6.2; angle += 0.7) {
    const Vector3d start(0.2 + 0.45 * std::cos(angle), 0.1 + 0.45 * std::sin(angle), 1.05);
    for (const Approach approach : {Approach::kAbove, Approach::kSide}) {
      const ReachPlan plan = Plan(MakeScene({.hand_at_m = start}), "wrap", approach);
      EXPECT_GE(plan.clearance_m, 0.002) << angle;
    }
  }
}

TEST(ReachPlannerTest, APointOnAPartIsGraspedThere) {
  Scene scene = MakeScene({});
  // A wide board with a thin rod on it: only the rod can be gripped.
  scene.bodies[kObject].shapes = {{Box{{0.3, 0.3, 0.02}}, {}},
                                  {Box{{0.2, 0.02, 0.02}}, {{0, 0.1, 0.05}}}};
  Simulation simulation(scene, {});
  const auto plan = [&](const Vector3d& point_m) {
    return PlanReach(scene, simulation.snapshot(),
                     {.hand = HandIndex(0),
                      .object = BodyIndex(kObject),
                      .style = FindStyle(scene.hands[0].model, "wrap"),
                      .approach = Approach::kAbove,
                      .point_m = point_m,
                      .from = {.X_WH = scene.hands[0].X_WH}});
  };
  const ReachPlan left = plan({-0.06, 0.1, 0.05}), right = plan({0.06, 0.1, 0.05});
  EXPECT_NEAR(std::abs((left.segment.q_end * Vector3d::UnitX()).y()), 1, 1e-9);
  EXPECT_LT((right.segment.curve_m[3] - left.segment.curve_m[3] - Vector3d(0.12, 0, 0)).norm(),
            1e-9);
  // Beside the rod's middle line, the middle counts.
  EXPECT_LT((plan({0.06, 0.105, 0.05}).segment.curve_m[3] - right.segment.curve_m[3]).norm(), 1e-9);
}

TEST(ReachPlannerTest, TheHandStaysAboveWhatIsBelowItAndOnlyThat) {
  Scene scene = MakeScene({.shape = Box{{0.06, 0.06, 0.04}}});
  Body& object = scene.bodies[kObject];
  const auto above_its_middle_m = [&] {
    return Plan(scene, "wrap", Approach::kSide).segment.curve_m[3].z() - object.X_WB.p_m.z();
  };
  EXPECT_NEAR(above_its_middle_m(), 0.055 - 0.02, 1e-9) << "on the table";
  object.X_WB.p_m.z() += 0.15;
  EXPECT_NEAR(above_its_middle_m(), 0, 1e-9) << "in the air";

  Body stand{.name = "stand", .shapes = {{Cylinder{0.015, 0.15}, {}}}, .fixed = true};
  stand.X_WB.p_m = object.X_WB.p_m - Vector3d(0, 0, 0.02 + 0.075);
  scene.bodies.push_back(stand);
  EXPECT_NEAR(above_its_middle_m(), 0, 1e-9) << "on a foot that is narrower than itself";
  scene.bodies.back().shapes = {{Box{{0.06, 0.06, 0.15}}, {}}};
  EXPECT_NEAR(above_its_middle_m(), 0.055 - 0.02, 1e-9) << "on a box as wide as itself";
}

TEST(ReachPlannerTest, AnOffsetMovesTheEnd) {
  const Scene scene = MakeScene({});
  const Vector3d offset(0, -0.15, 0);
  const Vector3d difference = Plan(scene, "wrap", Approach::kAbove, offset).segment.curve_m[3] -
                              Plan(scene, "wrap", Approach::kAbove).segment.curve_m[3];
  EXPECT_LT((difference - offset).norm(), 1e-9);
}

/// The same scene with a person who stands before the table and whose hand it is.
Scene WithOwner(Scene scene) {
  Person anna{.name = "anna",
              .head = BodyIndex(scene.bodies.size()),
              .has_body = true,
              .X_WS = {{-0.42, 0, 0}},
              .eyes = Eyes::kAhead};
  (scene.hands[0].model.left ? anna.left_hand : anna.right_hand) = HandIndex(0);
  const std::vector<Pose> places = PlacesOf(anna, Standing(scene, anna), {});
  for (std::size_t i = 0; Body part : PartsOf(anna)) {
    part.X_WB = places[i++];
    scene.bodies.push_back(part);
  }
  scene.persons.push_back(anna);
  return scene;
}

/// Where hand and object are 0.4 s after the hand has closed; metres and quaternions.
std::vector<Pose> GripOf(const Scene& scene, const std::string& style) {
  Simulation simulation(scene, MakeScript(PickAndPlace{.style = style}));
  for (int tick = 0; tick < 2 * scene.world.rate_hz && simulation.Step(); ++tick) {
  }
  return {simulation.snapshot().hands[0].palm.X_WB, simulation.snapshot().bodies[kObject].X_WB};
}

TEST(ReachPlannerTest, APersonsOwnBodyIsNotInTheWayOfHerHand) {
  for (const std::string hand : {"human_right", "human_left"}) {
    for (const GraspStyle& style : LibraryHand(hand).styles) {
      const double side_m = hand == "human_right" ? -0.2 : 0.2;
      const double width_m = std::min(0.06, 0.8 * style.opening_m);
      const Scene alone = MakeScene({.shape = Box{{width_m, width_m, 0.12}},
                                     .at_m = {0.15, side_m},
                                     .hand_at_m = {-0.1, side_m, 1.0},
                                     .hand = hand});
      const Scene with_body = WithOwner(alone);
      const std::vector<Pose> without = GripOf(alone, style.name),
                              with = GripOf(with_body, style.name);
      for (std::size_t i = 0; i < with.size(); ++i) {
        EXPECT_EQ((with[i].p_m - without[i].p_m).norm(), 0) << hand << ' ' << style.name;
        EXPECT_EQ(with[i].q.angularDistance(without[i].q), 0) << hand << ' ' << style.name;
      }
    }
  }
}

TEST(ReachPlannerTest, SomebodyElsesBodyIsInTheWay) {
  Scene scene = WithOwner(MakeScene({.at_m = {0.15, -0.2}, .hand_at_m = {-0.1, -0.2, 1.0}}));
  const double with_hers_m = Plan(scene, "wrap", Approach::kSide).clearance_m;
  scene.persons[0].right_hand = kNone;
  EXPECT_NE(Plan(scene, "wrap", Approach::kSide).clearance_m, with_hers_m);
}

}  // namespace
}  // namespace prehend::physics
