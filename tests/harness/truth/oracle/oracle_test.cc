// SPDX-License-Identifier: Apache-2.0
// The oracle on hand-made recordings: contact, support and grasp. Also what holds for all events.
#include "harness/truth/oracle/oracle.h"

#include <gtest/gtest.h>

#include "tests/harness/truth/oracle/oracle_stage.h"

namespace prehend::truth {
namespace {

using grammar::Tick;

TEST(OracleContact, BridgesGapsOfATenthOfASecondAndNoMore) {
  Stage stage;
  stage.Play(0.5);
  stage.cup_on_table = false;
  stage.Play(48 / 480.0);
  stage.cup_on_table = true;
  stage.Play(0.5);
  const Tick lost = stage.now();
  stage.cup_on_table = false;
  stage.Play(50 / 480.0);
  const Tick back = stage.now();
  stage.cup_on_table = true;
  stage.Play(0.5);
  EXPECT_EQ(Of("contact(cup, table)", stage.Truth()), (Intervals{{0, lost}, {back, stage.now()}}));
}

TEST(OracleContact, LastsToTheEndOfTheRunIfItNeverEnds) {
  Stage stage;
  stage.Play(0.5);
  for (const grammar::NamedEvent& event : stage.Truth().events) {
    EXPECT_TRUE(event.open_end);
    EXPECT_EQ(event.interval.end, stage.now());
  }
  stage.cup_on_table = false;
  stage.Play(0.5);
  for (const grammar::NamedEvent& event : stage.Truth().events) EXPECT_FALSE(event.open_end);
}

TEST(OracleContact, OfACompoundOrAWholeHandIsOne) {
  Stage stage;
  stage.sets = 3;
  stage.contacts = {{Stage::BodySide(1), Stage::BodySide(0), Eigen::Vector3d::UnitX()}};
  stage.Play(0.5);
  EXPECT_EQ(Of("contact(cup, hand)", stage.Truth()).size(), 1u);
  EXPECT_EQ(Of("contact(cup, table)", stage.Truth()).size(), 1u);
}

TEST(OracleSupport, IsNotFoundAtTheSide) {
  Stage stage;
  const int box = stage.AddBody("box", {0.06, 0.06, 0.06}, {0.56, 0, 0.03}, false);
  stage.contacts = {{Stage::BodySide(stage.cup), Stage::BodySide(box), {-1, 0, 0}}};
  stage.Play(0.5);
  const grammar::Timeline truth = stage.Truth();
  EXPECT_EQ(Of("contact(box, cup)", truth).size(), 1u);
  EXPECT_TRUE(Of("supported_by(cup, box)", truth).empty());
  EXPECT_TRUE(Of("supported_by(box, cup)", truth).empty());
  EXPECT_EQ(Of("supported_by(cup, table)", truth), (Intervals{{0, stage.now()}}));
  EXPECT_TRUE(Of("supported_by(table, cup)", truth).empty());
}

TEST(OracleSupport, OfAStackDoesNotDependOnTheOrderOfCreation) {
  for (const bool upper_first : {false, true}) {
    Stage stage;
    const int first =
        stage.AddBody("first", {0.06, 0.06, 0.06}, {0, 0, upper_first ? 0.09 : 0.03}, false);
    const int second =
        stage.AddBody("second", {0.06, 0.06, 0.06}, {0, 0, upper_first ? 0.03 : 0.09}, false);
    const Eigen::Vector3d normal_on_first(0, 0, upper_first ? 1 : -1);
    stage.contacts = {{Stage::BodySide(first), Stage::BodySide(second), normal_on_first}};
    stage.Play(0.5);
    EXPECT_EQ(Of("supported_by(first, second)", stage.Truth()).size(), upper_first ? 1u : 0u);
    EXPECT_EQ(Of("supported_by(second, first)", stage.Truth()).size(), upper_first ? 0u : 1u);
  }
}

TEST(OracleSupport, TravelsOnATray) {
  Stage stage;
  const int tray = stage.AddBody("tray", {0.4, 0.3, 0.01}, {0.5, 0, 0.3}, false);
  stage.cup_on_table = false;
  stage.contacts = {{Stage::BodySide(stage.cup), Stage::BodySide(tray)}};
  stage.Play(0.5, {0, 0, 0}, {{stage.cup, {0.2, 0, 0.4}}, {tray, {0.2, 0, 0.4}}});
  EXPECT_EQ(Of("supported_by(cup, tray)", stage.Truth()), (Intervals{{0, stage.now()}}));
}

TEST(OracleSupport, OnATurningTrayIsMeasuredWhereTheCupIs) {
  Stage stage;
  const int tray = stage.AddBody("tray", {0.4, 0.3, 0.01}, {0.3, 0, 0.3}, false);
  stage.cup_on_table = false;
  stage.contacts = {{Stage::BodySide(stage.cup), Stage::BodySide(tray)}};
  stage.body(tray).w_WB_rad_per_s = {0, -0.5, 0};  // lifts what is at its +x side: 0.2 m * 0.5 / s
  stage.Play(0.5, {0, 0, 0}, {{stage.cup, {0, 0, 0.1}}});
  EXPECT_EQ(Of("supported_by(cup, tray)", stage.Truth()), (Intervals{{0, stage.now()}}));
}

TEST(OracleSupport, BeginsWhenALandingHasComeToRest) {
  Stage stage;
  stage.Play(0.1, {0, 0, 0}, {{stage.cup, {0, 0, -0.1}}});
  const Tick rest = stage.now();
  stage.Play(0.5);
  EXPECT_EQ(Of("contact(cup, table)", stage.Truth()), (Intervals{{0, stage.now()}}));
  EXPECT_EQ(Of("supported_by(cup, table)", stage.Truth()), (Intervals{{rest, stage.now()}}));
}

TEST(OracleSupport, BeginsOnTheEdgeThatLandsFirst) {
  for (const bool edge_stays : {true, false}) {
    Stage stage;
    stage.cup_on_table = false;
    stage.Play(0.3);
    const Tick lands = stage.now();
    // The cup's centre sinks by 3 cm/s, 3 cm beside the edge about which it turns by 1 rad/s.
    stage.contacts = {{.a = Stage::BodySide(stage.cup),
                       .b = Stage::BodySide(stage.table),
                       .from_a_m = {-0.03, 0, -0.03}}};
    stage.body(stage.cup).w_WB_rad_per_s = {0, edge_stays ? 1.0 : 0.0, 0};
    stage.Play(0.3, {0, 0, 0}, {{stage.cup, {0, 0, -0.03}}});
    EXPECT_EQ(Of("supported_by(cup, table)", stage.Truth()),
              (edge_stays ? Intervals{{lands, stage.now()}} : Intervals{}));
  }
}

TEST(OracleSupport, IsJudgedWhereTheLoadIs) {
  for (const double load_n_s : {0.0, 1.0}) {
    Stage stage;
    stage.cup_on_table = false;
    // It bounces, turning by 2 rad/s: the edge behind is at rest, the one in front, 6 cm from it,
    // and the middle are not.
    const auto at = [&](double x_m, double impulse_n_s) {
      return Stage::Contact{.a = Stage::BodySide(stage.cup),
                            .b = Stage::BodySide(stage.table),
                            .from_a_m = {x_m, 0, -0.03},
                            .impulse_n_s = impulse_n_s};
    };
    stage.contacts = {at(-0.03, 1 - load_n_s), at(0.03, load_n_s)};
    stage.body(stage.cup).w_WB_rad_per_s = {0, -2.0, 0};
    stage.Play(0.3, {0, 0, 0}, {{stage.cup, {0, 0, 0.06}}});
    EXPECT_EQ(Of("supported_by(cup, table)", stage.Truth()).size(), load_n_s > 0 ? 0u : 1u);
  }
}

TEST(OracleSupport, LastsUntilTheyPart) {
  for (const bool asleep : {true, false}) {
    Stage stage;
    stage.cup_on_table = false;
    const auto bears = [&](double impulse_n_s) {
      stage.contacts = {{.a = Stage::BodySide(stage.cup),
                         .b = Stage::BodySide(stage.table),
                         .impulse_n_s = impulse_n_s}};
    };
    bears(0.004);  // in a tick, the weight of 200 g
    stage.Play(0.3);
    bears(1e-6);  // the last tick of a contact that flickers
    stage.Play(0.01);
    stage.body(stage.cup).asleep = asleep;
    stage.Play(1);
    const Tick parted = stage.now();
    ASSERT_EQ(Of("supported_by(cup, table)", stage.Truth()).size(), 1u);
    EXPECT_EQ(Of("supported_by(cup, table)", stage.Truth())[0].end, parted) << "nobody lifts it";
    stage.contacts.clear();
    stage.body(stage.cup).asleep = false;
    stage.Play(0.3);
    const Intervals supported = Of("supported_by(cup, table)", stage.Truth());
    ASSERT_EQ(supported.size(), 1u);
    EXPECT_LE(supported[0].end, parted + 1);
  }
}

TEST(OracleSupport, OfABlowThereIsNone) {
  for (const int frames_at_rest : {3, 6}) {
    Stage stage;
    stage.cup_on_table = false;
    stage.Play(0.3, {0, 0, 0}, {{stage.cup, {0.5, 0, -0.1}}});
    stage.cup_on_table = true;
    stage.Play(frames_at_rest / 240.0, {0, 0, 0}, {{stage.cup, {0.5, 0, 0}}});
    stage.cup_on_table = false;
    stage.Play(0.3, {0, 0, 0}, {{stage.cup, {0.5, 0, 0.1}}});
    EXPECT_EQ(Of("contact(cup, table)", stage.Truth()).size(), 1u);
    EXPECT_EQ(Of("supported_by(cup, table)", stage.Truth()).size(), frames_at_rest > 5 ? 1u : 0u);
  }
}

TEST(OracleSupport, StaysWhileWhatStoodThereTips) {
  Stage stage;
  stage.Play(0.3);
  stage.Play(0.3, {0, 0, 0}, {{stage.cup, {0, 0, 0.05}}});
  const Tick parts = stage.now();
  stage.cup_on_table = false;
  stage.Play(0.3, {0, 0, 0}, {{stage.cup, {0, 0, 0.05}}});
  EXPECT_EQ(Of("supported_by(cup, table)", stage.Truth()), (Intervals{{0, parts}}));
}

TEST(OracleSupport, OutlastsATrembleThatBreaksNoContact) {
  Stage stage;
  stage.Play(0.3);
  stage.Play(0.08, {0, 0, 0}, {{stage.cup, {0, 0, 0.03}}});
  stage.Play(0.3);
  EXPECT_EQ(Of("supported_by(cup, table)", stage.Truth()), (Intervals{{0, stage.now()}}));
}

TEST(OracleSupport, IsNotAHand) {
  Stage stage;
  stage.cup_on_table = false;
  stage.contacts = {{Stage::BodySide(stage.cup), Stage::HandSide(0, 2)}};
  stage.Play(0.5);
  EXPECT_EQ(Of("contact(cup, hand)", stage.Truth()).size(), 1u);
  for (const grammar::NamedEvent& event : stage.Truth().events)
    EXPECT_NE(event.event, "supported_by");
}

// A bar that a finger pulls at, and nothing grips, is none: not at the end of the recording either.
TEST(OracleGrasp, IsNotFoundOfOneFingerThatPullsToTheEnd) {
  Stage stage;
  stage.Play(0.5);
  stage.trigger = 1;
  stage.contacts = {{Stage::BodySide(stage.cup), Stage::HandSide(0, 0), Eigen::Vector3d::UnitX(),
                     Eigen::Vector3d::Zero(), 0.1}};
  stage.Play(0.5);
  EXPECT_EQ(Of("contact(cup, hand)", stage.Truth()).size(), 1u);
  EXPECT_TRUE(Of("grasping(hand, cup)", stage.Truth()).empty());
}

TEST(OracleGrasp, NeedsTwoSensorSetsAndACommand) {
  Stage stage;
  stage.sets = 2;
  stage.trigger = 0.29;
  stage.Play(0.3);
  stage.trigger = 0.3;
  stage.sets = 1;
  stage.Play(0.3);
  const Tick begin = stage.now();
  stage.sets = 2;
  stage.Play(0.3);
  const Tick end = stage.now();
  stage.trigger = 0.29;
  stage.Play(0.3);
  const grammar::Timeline truth = stage.Truth();
  EXPECT_EQ(Of("grasping(hand, cup)", truth), (Intervals{{begin, end}}));
  for (const grammar::NamedEvent& event : truth.events) {
    if (event.event != "grasping") continue;
    EXPECT_EQ(event.roles.back(), (grammar::Role{"style", "wrap"}));
  }
}

TEST(OracleGrasp, BridgesALossOfTheObjectButNotALettingGo) {
  struct Case {
    const char* what;
    double trigger, gap_s;
    std::size_t grasps;
  };
  for (const Case& c : {Case{"flicker", 1.0, 28 / 480.0, 1}, Case{"slip", 1.0, 30 / 480.0, 2},
                        Case{"letting go", 0.0, 10 / 480.0, 2}, Case{"re-grasp", 0.0, 0.2, 2}}) {
    Stage stage;
    stage.trigger = 1;
    stage.sets = 2;
    stage.Play(0.3);
    stage.trigger = c.trigger;
    stage.sets = 1;
    stage.Play(c.gap_s);
    stage.trigger = 1;
    stage.sets = 2;
    stage.Play(0.3);
    EXPECT_EQ(Of("grasping(hand, cup)", stage.Truth()).size(), c.grasps) << c.what;
    EXPECT_LE(Of("fixation(hand, cup)", stage.Truth()).size(), 1u) << c.what;
  }
}

TEST(OracleGrasp, CountsEveryHandAndEveryObject) {
  Stage stage;
  const int left = stage.AddHand("left", {0.6, 0, 0.03});
  const int wall = stage.AddBody("wall", {0.1, 1, 1}, {0.4, 0, 0.5}, true);
  stage.trigger = 1;
  stage.hand().trigger = 1;
  stage.sets = 2;
  for (const int set : {0, 1}) {
    stage.contacts.push_back({Stage::BodySide(wall), Stage::HandSide(0, set)});
    stage.contacts.push_back({Stage::BodySide(stage.cup), Stage::HandSide(left, set)});
  }
  stage.Play(0.3);
  EXPECT_EQ(Of("grasping(hand, cup)", stage.Truth()).size(), 1u);
  EXPECT_EQ(Of("grasping(hand, wall)", stage.Truth()).size(), 1u);
  EXPECT_TRUE(Of("transporting(hand, wall)", stage.Truth()).empty()) << "a wall is not carried";
  EXPECT_TRUE(Of("grasping(left, cup)", stage.Truth()).empty()) << "its grip is not commanded";
}

/// Two palms press on the cup with so much; the left one is turned by so much from the right one.
grammar::Timeline PressedByTwo(double right_n, double left_n, double turned_deg,
                               double left_trigger = 0, int left_sets = 1) {
  Stage stage;
  const int left = stage.AddHand("left", {0.6, 0, 0.03});
  stage.hand(left).trigger = left_trigger;
  stage.hand(left).palm.X_WB.q = physics::FromRollPitchYaw({turned_deg, 0, 0});
  stage.Play(0.2);
  for (int set = 0; set < left_sets; ++set)
    stage.contacts.push_back({.a = Stage::BodySide(stage.cup),
                              .b = Stage::HandSide(left, set),
                              .impulse_n_s = left_n / left_sets / 480});
  stage.contacts.push_back(
      {.a = Stage::BodySide(stage.cup), .b = Stage::HandSide(0, 2), .impulse_n_s = right_n / 480});
  stage.Play(0.3);
  stage.contacts.clear();
  stage.Play(0.2);
  return stage.Truth();
}

TEST(OracleGrasp, OfTwoHandsThatPressFromTwoSidesIsThatOfBoth) {
  const grammar::Timeline truth = PressedByTwo(2.1, 2.1, 180);
  const Intervals pressed = {{98, 242}};
  ExpectNear(Of("grasping(hand, cup)", truth), pressed);
  ExpectNear(Of("grasping(left, cup)", truth), pressed);
  EXPECT_EQ(Of("grasping(hand, cup)", PressedByTwo(2.1, 2.1, 121)).size(), 1u);
  for (const grammar::Timeline& none :
       {PressedByTwo(1.9, 5, 180), PressedByTwo(5, 1.9, 180), PressedByTwo(5, 5, 119),
        PressedByTwo(5, 5, 0), PressedByTwo(5, 5, 180, 1, 2)})
    EXPECT_TRUE(Of("grasping(hand, cup)", none).empty());
  EXPECT_EQ(Of("grasping(left, cup)", PressedByTwo(5, 5, 180, 1, 2)).size(), 1u)
      << "it holds the cup alone";
}

TEST(OracleGrasp, OfTwoThingsThatAreSqueezedTogetherIsThatOfBoth) {
  const auto squeezed = [](double cup_n, int box_set, double trigger, bool they_touch) {
    Stage stage;
    const int box = stage.AddBody("box", {0.06, 0.06, 0.06}, {0.56, 0, 0.03}, false);
    stage.trigger = trigger;
    stage.contacts = {
        {.a = Stage::BodySide(stage.cup), .b = Stage::HandSide(0, 0), .impulse_n_s = cup_n / 480},
        {.a = Stage::BodySide(box), .b = Stage::HandSide(0, box_set), .impulse_n_s = 5.0 / 480}};
    if (they_touch)
      stage.contacts.push_back({.a = Stage::BodySide(stage.cup), .b = Stage::BodySide(box)});
    stage.Play(0.3);
    const grammar::Timeline truth = stage.Truth();
    const std::size_t both = Of("grasping(hand, cup)", truth).size();
    EXPECT_EQ(Of("grasping(hand, box)", truth).size(), both);
    return both;
  };
  EXPECT_EQ(squeezed(5, 1, 1, true), 1u);
  EXPECT_EQ(squeezed(1.9, 1, 1, true), 0u);
  EXPECT_EQ(squeezed(5, 0, 1, true), 0u) << "one side of the grip touches both";
  EXPECT_EQ(squeezed(5, 1, 0.2, true), 0u) << "no grip is commanded";
  EXPECT_EQ(squeezed(5, 1, 1, false), 0u);
}

TEST(OracleGrasp, FingersThatOpenAndStrikeAnotherThingDoNotHoldOn) {
  Stage stage;
  const int box = stage.AddBody("box", {0.06, 0.06, 0.06}, {0.56, 0, 0.03}, false);
  const auto touch = [&](int body, int set) {
    stage.contacts.push_back(
        {.a = Stage::BodySide(body), .b = Stage::HandSide(0, set), .impulse_n_s = 5.0 / 480});
  };
  stage.contacts = {{.a = Stage::BodySide(stage.cup), .b = Stage::BodySide(box)}};
  touch(stage.cup, 1);
  touch(stage.cup, 2);
  stage.trigger = 1;
  stage.Play(0.3);
  stage.contacts.pop_back();
  stage.trigger = 0.95;
  stage.Play(0.02);
  for (int frame = 0; frame < 10; ++frame) {
    stage.trigger -= 0.02;
    if (frame == 5) touch(box, 0);
    stage.Play(0.01);
  }
  const Intervals held = Of("grasping(hand, cup)", stage.Truth());
  ASSERT_EQ(held.size(), 1u);
  EXPECT_NEAR(static_cast<double>(held[0].end), 0.3 * 480, 4);
  EXPECT_TRUE(Of("grasping(hand, box)", stage.Truth()).empty());
}

TEST(Oracle, TellsTheSameStoryAtEverySensingRate) {
  const auto play = [](int ticks_per_frame) {
    Stage stage(ticks_per_frame);
    stage.Play(0.2);
    stage.GraspCup();
    stage.Play(0.2);
    stage.Carry(0.4, {0.1, 0, 0});
    stage.cup_on_table = false;
    stage.Carry(0.4, {0, 0, 0.5});
    stage.Carry(0.4, {0, 0.5, 0});
    stage.Carry(0.4, {0, 0, -0.5});
    stage.cup_on_table = true;
    stage.Play(0.2);
    stage.sets = 0;
    stage.trigger = 0;
    stage.Play(0.2);
    return stage.Truth();
  };
  const grammar::Timeline every_tick = play(1);
  for (const int ticks_per_frame : {2, 6, 8, 16}) {  // 240, 80, 60 and 30 Hz
    const grammar::Timeline truth = play(ticks_per_frame);
    for (const char* event : {"reaching", "grasping", "sliding", "picking_up", "transporting",
                              "putting_down", "pick_and_place"}) {
      SCOPED_TRACE(std::string(event) + " every " + std::to_string(ticks_per_frame) + " ticks");
      const std::string label = std::string(event) + "(hand, cup)";
      EXPECT_EQ(Of(label, every_tick).size(), 1u);
      ExpectNear(Of(label, truth), Of(label, every_tick), 2 * ticks_per_frame);
    }
  }
}

}  // namespace
}  // namespace prehend::truth
