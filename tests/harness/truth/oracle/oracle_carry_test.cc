// SPDX-License-Identifier: Apache-2.0
// The oracle on hand-made recordings: what is done with a grasped object. Names in brackets: the
// paper's cases.
#include <gtest/gtest.h>

#include "tests/harness/truth/oracle/oracle_stage.h"

namespace prehend::truth {
namespace {

using grammar::Tick;

/// The cup, grasped on the table, after 0.2 s of rest.
class OracleCarry : public testing::Test {
 protected:
  void SetUp() override {
    stage_.GraspCup();
    stage_.Play(0.2);
  }

  /// Lifts it and returns when it lost the table.
  Tick Lift(double by_m, double m_per_s = 0.2) {
    const Tick lost = stage_.now();
    stage_.cup_on_table = false;
    stage_.Carry(by_m / m_per_s, {0, 0, m_per_s});
    return lost;
  }

  /// It stands on the table again, wherever that is, for 0.3 s. Returns since when.
  Tick Land() {
    const Tick landing = stage_.now();
    stage_.cup_on_table = true;
    stage_.Play(0.3);
    return landing;
  }

  Tick LetGo() {
    const Tick release = stage_.now();
    stage_.sets = 0;
    stage_.trigger = 0;
    stage_.Play(0.2);
    return release;
  }

  Intervals Events(const std::string& event) { return Of(event + "(hand, cup)", stage_.Truth()); }

  Stage stage_;
};

TEST_F(OracleCarry, PickUpGoesFromTheLossOfSupportToTheTopOfTheRegion) {  // and then (f, h)
  const Tick lost = Lift(0.12);
  const Tick out = stage_.now();
  stage_.Carry(0.5, {0, 0, 0.2});
  stage_.Carry(0.5, {0, 0.5, 0});
  stage_.Carry(0.7, {0, 0, -0.2});
  const Tick near = stage_.now();
  stage_.Carry(0.4, {0, 0, -0.2});
  const Tick landing = Land();
  LetGo();
  ExpectNear(Events("picking_up"), {{lost, out}});
  ExpectNear(Events("transporting"), {{out, near}});
  ExpectNear(Events("putting_down"), {{near, landing}});
  EXPECT_TRUE(Events("sliding").empty());
  ExpectNear(Events("pick_and_place"), {{Events("reaching").at(0).begin, landing}});
}

TEST_F(OracleCarry, SlideThenTransport) {  // (d), and (g): no put-down, a slide follows
  const Tick slide = stage_.now();
  stage_.Carry(0.4, {0.2, 0, 0});
  const Tick lost = stage_.now();
  stage_.cup_on_table = false;
  stage_.Carry(0.1, {0.2, 0, 0.1});
  stage_.Carry(1.0, {0.2, 0, 0});
  stage_.Carry(0.1, {0.2, 0, -0.1});
  const Tick second_slide = stage_.now();
  stage_.cup_on_table = true;
  stage_.Carry(0.4, {0.2, 0, 0});
  const Tick stop = stage_.now();
  stage_.Play(0.3);
  ExpectNear(Events("sliding"), {{slide, lost}, {second_slide, stop}});
  ExpectNear(Events("transporting"), {{lost, second_slide}});
  EXPECT_TRUE(Events("picking_up").empty());
  EXPECT_TRUE(Events("putting_down").empty());
}

TEST_F(OracleCarry, SlideThenPickUp) {  // (e)
  stage_.Carry(0.4, {0.2, 0, 0});
  const Tick lost = Lift(0.2);
  ExpectNear(Events("sliding"), {{lost - 192, lost}});
  ASSERT_EQ(Events("picking_up").size(), 1u);
  EXPECT_EQ(Events("picking_up")[0].begin, lost);
}

TEST_F(OracleCarry, ASlideNeedsTwoCentimetresAndPausesAreBridged) {
  stage_.Carry(0.05, {0.2, 0, 0});
  stage_.Play(0.5);
  EXPECT_TRUE(Events("sliding").empty());
  const Tick begin = stage_.now();
  stage_.Carry(0.08, {0.2, 0, 0});
  stage_.Play(0.14);
  stage_.Carry(0.08, {0.2, 0, 0});
  const Tick pause = stage_.now();
  stage_.Play(0.2);
  const Tick again = stage_.now();
  stage_.Carry(0.2, {-0.2, 0, 0});
  const Tick end = stage_.now();
  stage_.Play(0.3);
  ExpectNear(Events("sliding"), {{begin, pause}, {again, end}});
}

TEST_F(OracleCarry, AWayIsMeasuredWhereTheTwoTouch) {
  for (const double edge_m_per_s : {0.0, 0.05, 0.08}) {
    stage_ = Stage();
    SetUp();
    // It is tipped over an edge: its centre moves by 3 cm up and aside; the edge gets 0, 1.5 or
    // 2.4 cm farther.
    stage_.cup_on_table = false;
    stage_.contacts = {{.a = Stage::BodySide(stage_.cup),
                        .b = Stage::BodySide(stage_.table),
                        .from_a_m = {0.03, 0, -0.03}}};
    stage_.body(stage_.cup).w_WB_rad_per_s = {0, 0.1 / 0.03, 0};
    stage_.Carry(0.3, {0.1 + edge_m_per_s, 0, 0.1});
    EXPECT_EQ(Events("sliding").size(), edge_m_per_s > 0.07 ? 1u : 0u) << edge_m_per_s;
  }
}

TEST_F(OracleCarry, WhatIsTurnedOnTheSpotDoesNotSlideWhereverItBears) {
  for (const double m_per_s : {0.0, 0.15}) {
    stage_ = Stage();
    SetUp();
    // Fingers press one corner to the table, 4 cm from the middle, while the cup turns by 57
    // degrees about its middle: the corner gets 4 cm along the table. Then it moves on, too.
    stage_.cup_on_table = false;
    stage_.contacts = {{.a = Stage::BodySide(stage_.cup),
                        .b = Stage::BodySide(stage_.table),
                        .from_a_m = {0.03, 0.03, -0.03}}};
    stage_.body(stage_.cup).w_WB_rad_per_s = {0, 0, 2};
    const Tick begin = stage_.now();
    stage_.Carry(0.5, {m_per_s, 0, 0});
    const Tick end = stage_.now();
    stage_.body(stage_.cup).w_WB_rad_per_s.setZero();
    stage_.Play(0.3);
    ExpectNear(Events("sliding"), m_per_s > 0 ? Intervals{{begin, end}} : Intervals{});
  }
}

TEST_F(OracleCarry, AWayOnASlopeIsMeasuredInItsPlane) {
  // A board of 45 degrees: 2.4 cm along it are 1.7 cm on the level.
  stage_.cup_on_table = false;
  stage_.contacts = {{.a = Stage::BodySide(stage_.cup),
                      .b = Stage::BodySide(stage_.table),
                      .nhat_BA_W = Eigen::Vector3d(1, 0, 1).normalized(),
                      .impulse_n_s = 0.004}};
  stage_.Play(0.2);
  stage_.Carry(0.3, 0.08 * Eigen::Vector3d(1, 0, -1).normalized());
  EXPECT_EQ(Events("sliding").size(), 1u);
}

TEST_F(OracleCarry, TremblingIsNotSliding) {
  const auto tremble = [&] {
    for (int i = 0; i < 24; ++i) stage_.Carry(0.025, {i % 2 ? -0.04 : 0.04, 0, 0});
  };
  tremble();
  const Tick begin = stage_.now();
  stage_.Carry(0.4, {0.2, 0, 0});
  const Tick end = stage_.now();
  tremble();
  ExpectNear(Events("sliding"), {{begin, end}}, 24);  // a tremble next to the motion is part of it
}

TEST_F(OracleCarry, AJerkBeforeALiftIsNoMotionAndWhatLastsIs) {
  for (const int jerk_frames : {4, 16}) {
    stage_ = Stage();
    SetUp();
    const Tick begin = stage_.now();
    stage_.Carry(0.4, {0.2, 0, 0});
    const Tick stops = stage_.now();
    stage_.Play(0.08);
    stage_.Carry(jerk_frames / 240.0, {0.03, 0, 0});  // and it moves on in the air
    const Tick lost = stage_.now();
    stage_.cup_on_table = false;
    stage_.Carry(0.4, {0.03, 0, 0.2});
    ExpectNear(Events("sliding"), {{begin, jerk_frames < 12 ? stops : lost}});
  }
}

TEST_F(OracleCarry, AJerkOfTheClosingHandIsNoBeginOfASlide) {
  stage_.Carry(0.04, {0.02, 0, 0});
  stage_.Play(0.12);
  const Tick begin = stage_.now();
  stage_.Carry(0.3, {0.2, 0, 0});
  const Tick end = stage_.now();
  stage_.Play(0.3);
  ExpectNear(Events("sliding"), {{begin, end}});
}

TEST_F(OracleCarry, ThereAndBackIsASlide) {
  const Tick begin = stage_.now();
  stage_.Carry(0.3, {0.2, 0, 0});
  stage_.Carry(0.3, {-0.2, 0, 0});
  const Tick end = stage_.now();
  stage_.Play(0.3);
  ExpectNear(Events("sliding"), {{begin, end}});
}

TEST_F(OracleCarry, AReleasedCupDoesNotSlideAndACarriedTrayMakesNoSlide) {
  LetGo();
  stage_.Play(0.4, {0, 0, 0}, {{stage_.cup, {0.2, 0, 0}}});
  stage_.Play(0.4, {0, 0, 0}, {{stage_.cup, {0.2, 0, 0}}, {stage_.table, {0.2, 0, 0}}});
  EXPECT_TRUE(Events("sliding").empty());
  stage_.sets = 2;
  stage_.trigger = 1;
  stage_.Play(0.4, {0.2, 0, 0}, {{stage_.cup, {0.2, 0, 0}}, {stage_.table, {0.2, 0, 0}}});
  EXPECT_TRUE(Events("sliding").empty());
}

TEST_F(OracleCarry, ASlideOnAMovingTrayIsMeasuredFromTheTray) {
  const auto carry_tray = [&](double seconds, double cup_m_per_s) {
    stage_.Play(seconds, {cup_m_per_s, 0, 0},
                {{stage_.cup, {cup_m_per_s, 0, 0}}, {stage_.table, {0.3, 0, 0}}});
  };
  carry_tray(0.4, 0.3);
  carry_tray(0.1, 0.4);  // by 1 cm: not a slide
  carry_tray(0.4, 0.3);
  const Tick begin = stage_.now();
  carry_tray(0.3, 0.5);
  const Tick end = stage_.now();
  carry_tray(0.4, 0.3);
  ExpectNear(Events("sliding"), {{begin, end}});
}

TEST_F(OracleCarry, LetGoUpToTwentyMillisecondsBeforeTheLandingIsPutDown) {
  for (const int frames_before : {0, 1, 4, 7, 12}) {  // of 4.2 ms
    stage_ = Stage();
    stage_.GraspCup();
    stage_.Play(0.2);
    Lift(0.12);
    stage_.Carry(0.5, {0, 0.5, 0});
    stage_.Carry(0.6, {0, 0, -0.2});
    stage_.sets = 0;
    stage_.trigger = 0;
    const Tick let_go = stage_.now();
    stage_.Play(frames_before / 240.0);
    Land();
    const bool dropped = frames_before > 4;
    EXPECT_EQ(Events("putting_down").size(), dropped ? 0u : 1u) << frames_before;
    EXPECT_EQ(Events("pick_and_place").size(), dropped ? 0u : 1u) << frames_before;
    ASSERT_EQ(Events("transporting").size(), 1u);
    if (dropped) continue;
    EXPECT_LE(std::abs(Events("putting_down")[0].end - let_go), 2) << "with the grasp";
    EXPECT_EQ(Events("grasping")[0].end, Events("putting_down")[0].end);
  }
}

TEST_F(OracleCarry, WhatATouchLiftsIsPickedUpIfItIsGraspedBeforeItGotFar) {
  for (const bool far : {false, true}) {
    stage_ = Stage();
    stage_.Play(1.6, {0.6, 0, 0});
    stage_.trigger = 1;
    stage_.sets = 1;
    stage_.Play(0.1);
    Lift(far ? 0.2 : 0.04);
    const Tick grasp = stage_.now();
    stage_.sets = 2;
    stage_.Carry(0.4, {0, 0, 0.2});
    const Tick left = stage_.now();
    stage_.Carry(0.4, {0, 0, 0.2});
    if (far) {
      EXPECT_TRUE(Events("picking_up").empty());
      EXPECT_EQ(Events("transporting"), (Intervals{{grasp, stage_.now()}}));
    } else {
      ExpectNear(Events("picking_up"), {{grasp, left}});
      ExpectNear(Events("transporting"), {{left, stage_.now()}});
    }
  }
}

TEST_F(OracleCarry, ASnatchIsAPickUpEvenIfOneFrameSeesItAll) {
  stage_ = Stage(16);
  SetUp();
  const Tick lost = Lift(0.4, 4.0);
  EXPECT_EQ(Events("picking_up"), (Intervals{{lost, lost + 16}}));
}

TEST_F(OracleCarry, WhatIsHighBesideTheRegionInTheNextLookIsNoPickUp) {
  for (const int ticks_per_frame : {2, 16}) {
    stage_ = Stage(ticks_per_frame);
    SetUp();
    const Tick lost = stage_.now();
    stage_.cup_on_table = false;
    stage_.Carry(0.1, {1.2, 0, 0.1});
    stage_.Carry(0.1, {1.2, 0, 1.2});  // slowly seen, it is 5 cm high in the first look from beside
    EXPECT_TRUE(Events("picking_up").empty());
    ExpectNear(Events("transporting"), {{lost, stage_.now()}});
  }
}

TEST_F(OracleCarry, ASlideEndsWithTheGrasp) {
  const Tick begin = stage_.now();
  stage_.Carry(0.4, {0.2, 0, 0});
  const Tick release = stage_.now();
  stage_.sets = 0;
  stage_.trigger = 0;
  stage_.Play(0.4, {0.2, 0, 0}, {{stage_.cup, {0.2, 0, 0}}});
  ExpectNear(Events("sliding"), {{begin, release}});
}

TEST_F(OracleCarry, APutDownIsBackdatedToTheEntryOfItsRegion) {  // (i), from the side
  const Tick lost = Lift(0.06);
  stage_.Carry(1.0, {0.3, 0, 0});
  const Tick near = stage_.now() - static_cast<Tick>((0.09 / 0.3) * 480);
  stage_.Carry(0.3, {0, 0, -0.2});
  const Tick landing = Land();
  ExpectNear(Events("picking_up"), {{lost, lost + 144 + 144}});
  ExpectNear(Events("putting_down"), {{near, landing}}, 4);
}

TEST_F(OracleCarry, APutDownIsCutShortByMovingAway) {  // (j)
  for (const double away_m : {0.003, 0.03}) {
    stage_ = Stage();
    SetUp();
    Lift(0.2);
    stage_.Carry(0.6, {0, 0, -0.2});
    const Tick near = stage_.now();
    stage_.Carry(0.2, {0, 0, -0.2});
    stage_.Carry(away_m / 0.2, {0, 0, 0.2});
    const Tick turn = stage_.now();
    stage_.Carry((0.04 + away_m) / 0.2, {0, 0, -0.2});
    const Tick landing = Land();
    SCOPED_TRACE(away_m);
    ExpectNear(Events("putting_down"), {{away_m > 0.005 ? turn : near, landing}});
  }
}

TEST_F(OracleCarry, AnApproachThatBeganLowIsNoPutDown) {
  Lift(0.2);
  const Tick out = stage_.now() - static_cast<Tick>((0.08 / 0.2) * 480);
  stage_.Carry(0.2, {0.5, 0, 0});
  stage_.Carry(0.95, {0, 0, -0.2});  // a centimetre above the table
  stage_.Carry(0.3, {0.1, 0, 0});
  stage_.Carry(0.2, {-0.1, 0, 0});
  stage_.Carry(0.05, {0, 0, -0.2});
  const Tick landing = Land();
  EXPECT_TRUE(Events("putting_down").empty());
  ExpectNear(Events("transporting"), {{out, landing}});
}

TEST_F(OracleCarry, ALowArchRisesAndComesFromAbove) {
  const Tick lost = stage_.now();
  stage_.cup_on_table = false;
  stage_.Carry(0.4, {0.25, 0, 0.1});
  const Tick over = stage_.now();
  stage_.Carry(0.4, {0.25, 0, -0.1});
  const Tick landing = Land();
  const Tick near = landing - static_cast<Tick>(0.09 / 0.25 * 480);
  EXPECT_LT(over, near);
  ExpectNear(Events("picking_up"), {{lost, lost + static_cast<Tick>(0.09 / 0.25 * 480)}});
  ExpectNear(Events("putting_down"), {{near, landing}});
}

TEST_F(OracleCarry, APutDownStartsAtMostThreePointThreeSecondsBeforeTheLanding) {
  Lift(0.07);
  stage_.Carry(5.0, {0.1, 0, 0});
  stage_.Carry(7.0, {0, 0, -0.01});
  const Tick landing = Land();
  ExpectNear(Events("putting_down"), {{landing - 1584, landing}});
}

TEST_F(OracleCarry, LiftedAndPutBackInPlaceIsPickUpThenPutDown) {
  const Tick lost = Lift(0.06);
  const Tick top = stage_.now();
  stage_.Carry(0.3, {0, 0, -0.2});
  const Tick landing = Land();
  ExpectNear(Events("picking_up"), {{lost, top}});
  ExpectNear(Events("putting_down"), {{top, landing}});
  EXPECT_TRUE(Events("transporting").empty());
}

TEST_F(OracleCarry, AHopDuringASlideIsATransport) {
  const Tick first = stage_.now();
  stage_.Carry(0.3, {0.2, 0, 0});
  const Tick hop = stage_.now();
  stage_.cup_on_table = false;
  stage_.Carry(0.1, {0.2, 0, 0.1});
  stage_.Carry(0.1, {0.2, 0, -0.1});
  const Tick second = stage_.now();
  stage_.cup_on_table = true;
  stage_.Carry(0.3, {0.2, 0, 0});
  const Tick end = stage_.now();
  stage_.Play(0.2);
  ExpectNear(Events("sliding"), {{first, hop}, {second, end}});
  ExpectNear(Events("transporting"), {{hop, second}});
}

TEST_F(OracleCarry, TransportLastsToADropOrToTheEndOfTheEpisode) {
  for (const bool drop : {true, false}) {
    stage_ = Stage();
    SetUp();
    const Tick out = Lift(0.2) + 288;  // 0.12 m with 0.2 m/s
    stage_.Carry(0.5, {0, 0.5, 0});
    stage_.Carry(0.25, {0, 0, -0.2});
    const Tick end = stage_.now();
    if (drop) {
      LetGo();
      stage_.cup_on_table = true;
      stage_.Play(0.3);
    }
    ExpectNear(Events("transporting"), {{out, end}});
    EXPECT_TRUE(Events("putting_down").empty());
    EXPECT_TRUE(Events("pick_and_place").empty());
  }
}

TEST_F(OracleCarry, CaughtInTheAirIsTransportFromTheGrasp) {
  stage_ = Stage();
  stage_.cup_on_table = false;
  stage_.Play(0.3);
  const Tick caught = stage_.now();
  stage_.trigger = 1;
  stage_.sets = 2;
  stage_.Carry(0.5, {0, 0, 0.2});
  EXPECT_EQ(Events("transporting"), (Intervals{{caught, stage_.now()}}));
  EXPECT_TRUE(Events("picking_up").empty());
}

TEST_F(OracleCarry, CoversEveryUnsupportedMomentOfTheGraspOnce) {
  Lift(0.2);
  stage_.Carry(0.5, {0, 0.3, 0});
  stage_.Carry(1.0, {0, 0, -0.2});
  Land();
  Lift(0.05);
  stage_.Carry(0.25, {0, 0, -0.2});
  Land();
  Lift(0.01);
  stage_.Carry(0.5, {0, 0.3, 0});
  LetGo();
  const grammar::Interval grasp = Events("grasping").at(0);
  std::vector<int> covered(stage_.now());
  const auto cover = [&](const Intervals& intervals) {
    for (const grammar::Interval& interval : intervals)
      for (Tick tick = interval.begin; tick < interval.end; ++tick) ++covered[tick];
  };
  for (const char* event : {"picking_up", "transporting", "putting_down"}) cover(Events(event));
  for (const grammar::Interval& supported : Of("supported_by(cup, table)", stage_.Truth()))
    cover({{std::max(supported.begin, grasp.begin), std::min(supported.end, grasp.end)}});
  for (Tick tick = 0; tick < stage_.now(); ++tick)
    ASSERT_EQ(covered[tick], tick >= grasp.begin && tick < grasp.end ? 1 : 0) << "tick " << tick;
}

}  // namespace
}  // namespace prehend::truth
