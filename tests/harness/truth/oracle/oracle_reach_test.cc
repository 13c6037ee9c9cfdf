// SPDX-License-Identifier: Apache-2.0
// The oracle on hand-made recordings: reaching and fixation.
#include <gtest/gtest.h>

#include "harness/truth/oracle/evidence.h"
#include "tests/harness/truth/oracle/oracle_stage.h"

namespace prehend::truth {
namespace {

using grammar::Tick;

constexpr double kFrame_s = 2 / 480.0;

// The hand's region ends 0.6 m ahead of the palm, the cup's near side is at x = 0.47.
constexpr double kRegionEntry_x_m = 0.47 - 0.6;

/// From where it is straight to the given x, with 0.5 m/s.
void MoveHandTo(Stage& stage, double x_m) {
  const double by_m = x_m - stage.hand().palm.X_WB.p_m.x();
  stage.Play(std::abs(by_m) / 0.5, {by_m > 0 ? 0.5 : -0.5, 0, 0});
}

/// Touches and at once grasps the cup. Returns when.
Tick Grasp(Stage& stage) {
  const Tick touch = stage.now();
  stage.trigger = 1;
  stage.sets = 2;
  stage.Play(0.3);
  return touch;
}

TEST(OracleReach, BeginsWhereTheCupEntersTheRegion) {
  Stage stage;
  MoveHandTo(stage, kRegionEntry_x_m);
  const Tick entry = stage.now();
  MoveHandTo(stage, 0.45);
  const Tick touch = Grasp(stage);
  ExpectNear(Of("reaching(hand, cup)", stage.Truth()), {{entry, touch}});
  EXPECT_TRUE(Of("fixation(hand, cup)", stage.Truth()).empty());
}

TEST(OracleReach, EndsWithTheFirstTouchAndFixationFillsTheTimeToTheGrasp) {
  Stage stage;
  MoveHandTo(stage, 0.45);
  const Tick touch = stage.now();
  stage.sets = 1;
  stage.Play(0.15);
  const Tick grasp = Grasp(stage);
  EXPECT_EQ(Of("reaching(hand, cup)", stage.Truth()).front().end, touch);
  EXPECT_EQ(Of("fixation(hand, cup)", stage.Truth()), (Intervals{{touch, grasp}}));
}

TEST(OracleReach, BeginsAnewAtTheTurningPointOfARetreat) {
  for (const double retreat_m : {0.02, 0.03, 0.10}) {
    Stage stage;
    MoveHandTo(stage, kRegionEntry_x_m);
    const Tick entry = stage.now();
    MoveHandTo(stage, 0.2);
    MoveHandTo(stage, 0.2 - retreat_m);
    const Tick turn = stage.now();
    MoveHandTo(stage, 0.45);
    const Tick touch = Grasp(stage);
    SCOPED_TRACE(retreat_m);
    ExpectNear(Of("reaching(hand, cup)", stage.Truth()),
               {{retreat_m > 0.025 ? turn : entry, touch}});
  }
}

TEST(OracleReach, BeginsWithTheFirstMotionBackWhenARetreatEndsInAPause) {
  for (const double creep_m_per_s : {-0.005, 0.0005, 0.005}) {  // the last one is motion back
    Stage stage;
    MoveHandTo(stage, 0.2);
    MoveHandTo(stage, 0.1);
    const Tick pause = stage.now();
    stage.Play(0.4, {creep_m_per_s, 0, 0});
    const Tick back = creep_m_per_s > 0.001 ? pause : stage.now();
    MoveHandTo(stage, 0.45);
    const Tick touch = Grasp(stage);
    SCOPED_TRACE(creep_m_per_s);
    ExpectNear(Of("reaching(hand, cup)", stage.Truth()), {{back, touch}});
  }
}

TEST(OracleReach, BeginsNotWhileTheHandStandsStill) {
  Stage stage;
  stage.hand().palm.X_WB.p_m.x() = 0.2;
  stage.Play(0.3);
  const Tick start = stage.now();
  MoveHandTo(stage, 0.45);
  const Tick touch = Grasp(stage);
  ExpectNear(Of("reaching(hand, cup)", stage.Truth()), {{start, touch}});
}

TEST(OracleReach, BeginsNotWhileTheHandSettles) {
  Stage stage;
  stage.hand().palm.X_WB.p_m.x() = 0.2;
  stage.Play(4 / 240.0, {0.003, 0, 0});
  stage.Play(0.1);
  const Tick start = stage.now();
  MoveHandTo(stage, 0.45);
  const Tick touch = Grasp(stage);
  ExpectNear(Of("reaching(hand, cup)", stage.Truth()), {{start, touch}});
}

TEST(OracleReach, BeginsWithASlowStart) {
  Stage stage;
  MoveHandTo(stage, 0.2);
  stage.Play(1.0);
  const Tick start = stage.now();
  for (int i = 1; i <= 20; ++i) stage.Play(0.02, {0.002 * i, 0, 0});
  MoveHandTo(stage, 0.45);
  const Tick touch = Grasp(stage);
  ExpectNear(Of("reaching(hand, cup)", stage.Truth()), {{start, touch}});
}

TEST(OracleReach, BeginsAnewAfterLeavingTheRegion) {
  Stage stage;
  MoveHandTo(stage, 0.2);
  MoveHandTo(stage, -0.4);
  MoveHandTo(stage, kRegionEntry_x_m);
  const Tick entry = stage.now();
  MoveHandTo(stage, 0.45);
  const Tick touch = Grasp(stage);
  ExpectNear(Of("reaching(hand, cup)", stage.Truth()), {{entry, touch}});
}

TEST(OracleReach, BeginsAnewAfterIdlingLongerThanHalfASecond) {
  for (const double idle_s : {0.4, 0.6}) {
    Stage stage;
    MoveHandTo(stage, kRegionEntry_x_m);
    const Tick entry = stage.now();
    MoveHandTo(stage, 0.2);
    stage.Play(idle_s);
    const Tick idle_end = stage.now();
    MoveHandTo(stage, 0.45);
    const Tick touch = Grasp(stage);
    SCOPED_TRACE(idle_s);
    ExpectNear(Of("reaching(hand, cup)", stage.Truth()),
               {{idle_s > 0.5 ? idle_end : entry, touch}});
  }
}

TEST(OracleReach, IsNotTheComingOfTheCup) {
  Stage stage;
  stage.hand().palm.X_WB.p_m.x() = 0;
  stage.Play(1.0, {0, 0, 0}, {{stage.cup, {-0.43, 0, 0}}});
  Grasp(stage);
  EXPECT_EQ(Of("grasping(hand, cup)", stage.Truth()).size(), 1u);
  EXPECT_TRUE(Of("reaching(hand, cup)", stage.Truth()).empty());
}

TEST(OracleReach, GoesOnWhileFollowingTheCup) {
  Stage stage;
  MoveHandTo(stage, kRegionEntry_x_m);
  const Tick entry = stage.now();
  stage.Play(1.0, {0.2, 0, 0}, {{stage.cup, {0.2, 0, 0}}});
  MoveHandTo(stage, 0.65);
  const Tick touch = Grasp(stage);
  ExpectNear(Of("reaching(hand, cup)", stage.Truth()), {{entry, touch}});
}

TEST(OracleReach, GoesOnWhileOnlyTheFingersClose) {
  Stage stage;
  MoveHandTo(stage, kRegionEntry_x_m);
  const Tick entry = stage.now();
  MoveHandTo(stage, 0.4);
  for (int frame = 0; frame < 180; ++frame) {  // 0.75 s
    stage.finger_m.x() += 0.0001;
    stage.Play(kFrame_s);
  }
  const Tick touch = Grasp(stage);
  ExpectNear(Of("reaching(hand, cup)", stage.Truth()), {{entry, touch}});
}

TEST(OracleReach, MustNotBeTooShort) {
  for (const double approach_s : {0.08, 0.12}) {
    Stage stage;
    stage.hand().palm.X_WB.p_m.x() = -1;
    stage.Play(0.1);
    stage.hand().palm.X_WB.p_m.x() = 0.2;  // out of nowhere
    stage.Play(approach_s, {2, 0, 0});
    Grasp(stage);
    EXPECT_EQ(Of("reaching(hand, cup)", stage.Truth()).size(), approach_s > 0.1 ? 1u : 0u);
  }
}

TEST(OracleReach, IsOnlyForWhatIsThenGrasped) {
  Stage stage;
  const int milk = stage.AddBody("milk", {0.06, 0.06, 0.2}, {0.5, 0.1, 0.1}, false);
  MoveHandTo(stage, 0.45);
  stage.contacts = {{Stage::BodySide(milk), Stage::HandSide(0, 0)}};
  stage.Play(0.2);
  Grasp(stage);
  EXPECT_EQ(Of("reaching(hand, cup)", stage.Truth()).size(), 1u);
  EXPECT_TRUE(Of("reaching(hand, milk)", stage.Truth()).empty());
  EXPECT_TRUE(Of("fixation(hand, milk)", stage.Truth()).empty());
}

TEST(OracleReach, ForASecondObjectBeginsNotBeforeTheFirstIsGrasped) {
  Stage stage;
  const int milk = stage.AddBody("milk", {0.06, 0.06, 0.2}, {0.6, 0, 0.1}, false);
  MoveHandTo(stage, 0.40);
  const Tick first = stage.now();
  stage.trigger = 1;
  stage.sets = 2;
  MoveHandTo(stage, 0.50);
  const Tick second = stage.now();
  stage.contacts = {{Stage::BodySide(milk), Stage::HandSide(0, 0)},
                    {Stage::BodySide(milk), Stage::HandSide(0, 2)}};
  stage.Play(0.2);
  ExpectNear(Of("reaching(hand, milk)", stage.Truth()), {{first, second}});
  EXPECT_GT(Of("reaching(hand, milk)", stage.Truth())[0].begin, first);
}

TEST(OracleReach, BeginsAnewAfterATouchThatLedToNothing) {
  Stage stage;
  MoveHandTo(stage, 0.45);
  stage.sets = 1;
  stage.Play(0.1);
  stage.sets = 0;
  const Tick lost = stage.now();
  MoveHandTo(stage, 0.43);
  stage.Play(0.1);
  MoveHandTo(stage, 0.45);
  const Tick touch = Grasp(stage);
  EXPECT_EQ(Of("reaching(hand, cup)", stage.Truth()), (Intervals{{lost, touch}}));
}

TEST(OracleReach, BelongsToTheFirstGraspOfAContact) {
  Stage stage;
  MoveHandTo(stage, 0.45);
  const Tick touch = Grasp(stage);
  stage.trigger = 0;
  stage.Play(0.15);
  Grasp(stage);
  EXPECT_EQ(Of("grasping(hand, cup)", stage.Truth()).size(), 2u);
  ASSERT_EQ(Of("reaching(hand, cup)", stage.Truth()).size(), 1u);
  EXPECT_EQ(Of("reaching(hand, cup)", stage.Truth())[0].end, touch);
  EXPECT_TRUE(Of("fixation(hand, cup)", stage.Truth()).empty());
}

TEST(OracleDistance, IsMeasuredBetweenSurfacesOfEveryShape) {
  struct Case {
    physics::Shape shape;
    double distance_m;
  };
  // The palm's face is 1 cm ahead of its centre, the object's centre 30 cm.
  const double diagonal_m = std::sqrt(0.5) * 0.1;
  const Case cases[] = {
      {physics::Box{{0.1, 0.1, 0.1}}, 0.29 - diagonal_m},  // turned by 45 degrees: an edge
      {physics::Sphere{0.05}, 0.24},
      {physics::Cylinder{0.05, 0.1}, 0.24},
      {physics::Capsule{0.05, 0.1}, 0.24}};
  physics::HandModel model = SmallHand();
  model.links.clear();
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(M_PI / 4, Eigen::Vector3d::UnitZ()));
  for (const Case& c : cases) {
    const physics::Body body{.name = "thing", .shapes = {{c.shape, {}}}};
    const physics::BodyState state{.X_WB = {{0.3, 0, 0}, turned}};
    EXPECT_NEAR(SurfaceDistance(model, {}, body, state), c.distance_m, 1e-4) << c.shape.index();
  }
}

}  // namespace
}  // namespace prehend::truth
