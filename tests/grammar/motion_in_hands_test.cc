// SPDX-License-Identifier: Apache-2.0
// Grasps and stirring of motion, as recordings of people have them: things that swing and turn in
// the hand, fast hand-overs, stirring to and fro. Only poses are known, 60 times a second.
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "grammar/name_events.h"
#include "tests/grammar/corpus.h"

namespace prehend::grammar {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

struct Pose {
  Vector3d p_m = Vector3d::Zero();
  Quaterniond q = Quaterniond::Identity();
};
using Span = std::pair<double, double>;  // seconds

EntityInfo Thing(const std::string& name, const Vector3d& half_size_m) {
  EntityInfo info{.name = name, .classes = {"Object", "Movable", "Thing", "Entity"}};
  info.half_size_m = half_size_m;
  return info;
}

EntityInfo Hand(const std::string& name) { return {.name = name, .classes = {"Hand", "Entity"}}; }

/// What is recognised of a table, whose top is at 0, and `things`, which are where `at` says.
std::map<std::string, std::vector<Span>> Recognise(
    const std::shared_ptr<const Program>& program, const std::vector<EntityInfo>& things,
    double end_s, const std::function<std::vector<Pose>(double)>& at) {
  EntityTable entities{.ticks_per_second = 240};
  entities.entities = {{.name = "table", .classes = {"Fixed", "Thing", "Entity"}}};
  entities.entities[0].half_size_m = {2, 2, 0.02};
  entities.entities.insert(entities.entities.end(), things.begin(), things.end());
  Monitor monitor(program, entities);
  std::vector<Event> events;
  std::vector<EntitySample> looks(things.size() + 1);
  looks[0].p_WB_m.z() = -0.02;
  const auto end = static_cast<Tick>(end_s * 240);
  for (Tick tick = 0; tick <= end; tick += 4) {
    const std::vector<Pose> poses = at(static_cast<double>(tick) / 240);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      EntitySample& look = looks[i + 1];
      look.v_WB_m_per_s =
          tick == 0 ? Vector3d(0, 0, 0) : Vector3d((poses[i].p_m - look.p_WB_m) * 60);
      look.p_WB_m = poses[i].p_m;
      look.q_WB = poses[i].q;
    }
    // A hand of which nothing else is known is a point.
    std::vector<CollisionSphere> spheres(looks.size());
    std::vector<HandSample> hands;
    for (std::size_t i = 0; i < looks.size(); ++i) {
      spheres[i].p_W_m = looks[i].p_WB_m;
      if (entities.entities[i].classes.front() == "Hand")
        hands.push_back({.entity = static_cast<int>(i), .collision_spheres = {&spheres[i], 1}});
    }
    monitor.Advance({.tick = tick, .entities = looks, .hands = hands, .touches = {}}, events);
  }
  monitor.Finish(end + 4, events);
  EXPECT_EQ(monitor.error(), "");
  std::map<std::string, std::vector<Span>> found;
  for (const NamedEvent& event : NameEvents(*program, entities, events).events)
    found[event.Label()].emplace_back(static_cast<double>(event.interval.begin) / 240,
                                      static_cast<double>(event.interval.end) / 240);
  return found;
}

double Smooth(double s, double from_s, double to_s) {
  const double share = std::clamp((s - from_s) / (to_s - from_s), 0.0, 1.0);
  return share * share * (3 - 2 * share);
}

void ExpectSpans(const std::vector<Span>& found, const std::vector<Span>& wanted, double within_s) {
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i].first, wanted[i].first, within_s);
    EXPECT_NEAR(found[i].second, wanted[i].second, within_s);
  }
}

// A pan hangs 15 cm below the fingers that carry it. From 2.0 to 4.0 s they are still, and it
// swings on.
TEST(MotionInHands, WhatSwingsOnInAHandThatSlowsStaysInIt) {
  const auto found =
      Recognise(testing::CompileLibrary("pick_and_place_from_motion"),
                {Thing("pan", {0.08, 0.08, 0.03}), Hand("hand")}, 7, [](double s) {
                  const double up_m = 0.3 * (Smooth(s, 1, 1.6) - Smooth(s, 5, 5.6));
                  const double swing = 0.6 * (Smooth(s, 1.6, 2) - Smooth(s, 4, 4.4)) *
                                       std::sin(2 * std::numbers::pi * 1.2 * (s - 1.6));
                  const Quaterniond turned(Eigen::AngleAxisd(swing, Vector3d::UnitY()));
                  const Vector3d fingers(0.4 * Smooth(s, 1.3, 2), 0, 0.18 + up_m);
                  const Vector3d away(-0.4 * (1 - Smooth(s, 0, 0.8) + Smooth(s, 6, 6.7)), 0, 0);
                  return std::vector<Pose>{{fingers + turned * Vector3d(0, 0, -0.15), turned},
                                           {fingers + away, Quaterniond::Identity()}};
                });
  ASSERT_TRUE(found.contains("grasping(hand, pan)"));
  ExpectSpans(found.at("grasping(hand, pan)"), {{1.1, 6.1}}, 0.15);
}

// From hand to hand at a metre per second: the bottle turns in the hand that takes it, and slips by
// 25 cm/s. The one that gives it stops at 2.2 s: until then it is held by that one.
TEST(MotionInHands, AFastHandOverSlipsAndIsAGraspOfEachHand) {
  const auto found = Recognise(
      testing::CompileLibrary("pick_and_place_from_motion"),
      {Thing("bottle", {0.035, 0.035, 0.1}), Hand("giver"), Hand("taker")}, 4.5, [](double s) {
        const double along_m = std::clamp(s - 2.0, 0.0, 1.2);
        const double turn = 2 * std::numbers::pi * 1.5 * (s - 2);
        const Vector3d bottle(along_m, 0, 0.1 + 0.4 * Smooth(s, 0.8, 1.4));
        const Vector3d to_giver(-0.07 - 0.4 * (1 - Smooth(s, 0, 0.7)), 0, 0);
        const Vector3d giver = bottle + to_giver - Vector3d(std::max(0.0, along_m - 0.2), 0, 0);
        const Vector3d slip = 0.0265 * Vector3d(std::cos(turn) - 1, std::sin(turn), 0);
        const Vector3d taker = bottle + Vector3d(0.07 + 0.5 * (1 - Smooth(s, 1.2, 1.9)), 0, 0) +
                               (along_m > 0 && along_m < 1.2 ? slip : Vector3d(0, 0, 0));
        return std::vector<Pose>{{bottle}, {giver}, {taker}};
      });
  ASSERT_TRUE(found.contains("grasping(giver, bottle)"));
  ASSERT_TRUE(found.contains("grasping(taker, bottle)"));
  ExpectSpans(found.at("grasping(giver, bottle)"), {{0.87, 2.2}}, 0.1);
  ExpectSpans(found.at("grasping(taker, bottle)"), {{2.2, 4.5}}, 0.1);
}

// A rod 1.1 m up in the air, 10 cm long, is carried from 1 to 2 s and from 3.5 s on; nothing bears
// it. `at` says where rod, hand and another hand are, of the carried rod and the hand at its end.
std::vector<Span> GraspsOfARod(
    const std::function<std::vector<Vector3d>(double, const Vector3d&, const Vector3d&)>& at,
    const std::string& whose = "hand") {
  const auto found =
      Recognise(testing::CompileLibrary("pick_and_place_from_motion"),
                {Thing("rod", {0.05, 0.02, 0.02}), Hand("hand"), Hand("other")}, 6, [&](double s) {
                  const Vector3d rod(0.3 * Smooth(s, 1, 2) + 0.3 * Smooth(s, 3.5, 4.7), 0,
                                     1.1 + 0.1 * Smooth(s, 1, 2));
                  std::vector<Pose> poses;
                  for (const Vector3d& p_m : at(s, rod, rod - Vector3d(0.1, 0, 0)))
                    poses.push_back({p_m});
                  return poses;
                });
  const auto spans = found.find("grasping(" + whose + ", rod)");
  return spans == found.end() ? std::vector<Span>() : spans->second;
}

TEST(MotionInHands, AGripMayBeShiftedInMidAir) {
  const Vector3d idle(0.8, 0.3, 0.9);
  // By 7 and 12 cm, while it is still, and while it is carried.
  for (const double by_m : {0.07, 0.12}) {
    for (const double from_s : {1.9, 3.8}) {
      const auto grasps = GraspsOfARod([&](double s, const Vector3d& rod, const Vector3d& hand) {
        const double shift_m = by_m * Smooth(s, from_s, from_s + 0.6);
        return std::vector{rod, Vector3d(hand - Vector3d(shift_m, 0, 0)), idle};
      });
      ExpectSpans(grasps, {{1.1, 6}}, 0.15);
    }
  }
}

TEST(MotionInHands, WhatFallsOrIsTakenInMidAirIsLetGoOf) {
  // It falls at 2.5 s.
  ExpectSpans(GraspsOfARod([](double s, Vector3d rod, Vector3d hand) {
                if (s > 3.5) rod.x() = 0.3, hand.x() = 0.2;
                const double fallen_s = std::max(0.0, s - 2.5);
                rod.z() = std::max(0.02, rod.z() - 9.81 / 2 * fallen_s * fallen_s);
                return std::vector{rod, hand, Vector3d(0.8, 0.3, 0.9)};
              }),
              {{1.1, 2.5}}, 0.1);
  // Another hand comes to its other end; the first one leaves at 2.9 s, upward or aside, or stays
  // where it is when the other one carries the rod on at 3.5 s.
  for (const Vector3d& away_m : {Vector3d(0, 0, 0.15), Vector3d(-0.3, 0.1, 0), Vector3d(0, 0, 0)}) {
    const auto at = [&](double s, const Vector3d& rod, Vector3d hand) {
      if (s > 3.5) hand.x() = 0.2;
      const double far_m = 0.1 + 0.6 * (1 - Smooth(s, 1, 2.8));
      return std::vector{rod, Vector3d(hand + away_m * Smooth(s, 2.9, 3.5)),
                         Vector3d(rod + Vector3d(far_m, 0, 0))};
    };
    ExpectSpans(GraspsOfARod(at), {{1.1, away_m.norm() > 0 ? 3.0 : 3.65}}, 0.16);
    const auto taken = GraspsOfARod(at, "other");
    ASSERT_EQ(taken.size(), 1u);
    EXPECT_NEAR(taken[0].second, 6, 0.1);
  }
}

// A board of 60 cm turns by 90 degrees about the palm that holds its edge. From the markers on the
// wrist, 12 cm behind the palm, its middle gets 10 cm nearer; no gap opens.
TEST(MotionInHands, ALargeThingThatTurnsInTheHandStaysInIt) {
  const auto found = Recognise(
      testing::CompileLibrary("pick_and_place_from_motion"),
      {Thing("board", {0.3, 0.2, 0.02}), Hand("hand")}, 6, [](double s) {
        const double turn = std::numbers::pi / 2 * (Smooth(s, 2, 2.8) - Smooth(s, 3.2, 4));
        const Quaterniond turned(Eigen::AngleAxisd(turn, Vector3d::UnitZ()));
        const Vector3d palm(0, 0,
                            0.02 + 0.3 * (Smooth(s, 1, 1.6) - Smooth(s, 4.2, 4.8)) +
                                0.02 * std::sin(2 * std::numbers::pi * s) *
                                    (Smooth(s, 1.6, 2) - Smooth(s, 4, 4.2)));
        const Vector3d away(-0.5 * (1 - Smooth(s, 0, 0.8) + Smooth(s, 5.2, 5.9)), 0, 0);
        return std::vector<Pose>{{palm + turned * Vector3d(0.3, 0, 0), turned},
                                 {palm + Vector3d(-0.12, 0, 0) + away}};
      });
  ASSERT_TRUE(found.contains("grasping(hand, board)"));
  ExpectSpans(found.at("grasping(hand, board)"), {{1.1, 5.35}}, 0.15);
}

std::shared_ptr<const Program> Compiled(const std::string& uses) {
  const CompileResult compiled = Compile({.file = "mine.grammar", .text = "grammar mine\n" + uses},
                                         testing::LibraryIncluder());
  EXPECT_TRUE(compiled.program) << Format(compiled.diagnostics);
  return compiled.program;
}

std::shared_ptr<const Program> Stirring() {
  return Compiled("use contact from motion\nuse stirring from motion\n");
}

/// A spoon is put into a bowl at 2 s, is moved `stroke` about there until 7 s, and is taken out.
/// The bowl goes along `bowl`.
std::map<std::string, std::vector<Span>> Stirred(
    const std::shared_ptr<const Program>& program, const std::function<Vector3d(double)>& stroke,
    const std::function<Vector3d(double)>& bowl = [](double) { return Vector3d(0, 0, 0); }) {
  return Recognise(
      program, {Thing("spoon", {0.01, 0.01, 0.1}), Thing("bowl", {0.1, 0.1, 0.05}), Hand("hand")},
      9, [&](double s) {
        const double aside_m = 0.4 * (1 - Smooth(s, 1.2, 1.8) + Smooth(s, 7.4, 8));
        const double up_m = 0.25 * (Smooth(s, 0.8, 1.2) - Smooth(s, 8, 8.4));
        const double in_m = 0.2 * (Smooth(s, 1.8, 2) - Smooth(s, 7, 7.2));
        const Vector3d spoon = bowl(s) + Vector3d(aside_m, 0, 0.1 + up_m - in_m) +
                               (Smooth(s, 2, 2.2) - Smooth(s, 6.8, 7)) * stroke(s);
        const Vector3d away(0, -0.4 * (1 - Smooth(s, 0, 0.7) + Smooth(s, 8.5, 9)), 0);
        return std::vector<Pose>{
            {spoon}, {bowl(s) + Vector3d(0, 0, 0.05)}, {spoon + Vector3d(0, 0, 0.12) + away}};
      });
}

Vector3d ToAndFro(double s) {
  const double turn = 2 * std::numbers::pi * 1.5 * s;
  return {0.05 * std::sin(turn), 0.004 * std::cos(turn), 0};
}

TEST(MotionInHands, ToAndFroIsStirring) {
  const auto found = Stirred(Stirring(), ToAndFro);
  ASSERT_TRUE(found.contains("stirring(hand, spoon, bowl)"));
  ExpectSpans(found.at("stirring(hand, spoon, bowl)"), {{2, 7}}, 0.5);
}

TEST(MotionInHands, RoundIsStirring) {
  const auto found = Stirred(Stirring(), [](double s) {
    const double turn = 2 * std::numbers::pi * 1.2 * s;
    return Vector3d(0.03 * std::sin(turn), 0.03 * std::cos(turn), 0);
  });
  ASSERT_TRUE(found.contains("stirring(hand, spoon, bowl)"));
  ExpectSpans(found.at("stirring(hand, spoon, bowl)"), {{2, 7}}, 0.5);
}

// A spoon that trembles in the bowl turns all the time, and gets nowhere.
TEST(MotionInHands, TremblingIsNoStirring) {
  const auto found = Stirred(Stirring(), [](double s) {
    const double turn = 2 * std::numbers::pi * 2 * s;
    return Vector3d(0.002 * std::sin(turn), 0.002 * std::cos(turn), 0);
  });
  ASSERT_TRUE(found.contains("grasping(hand, spoon)"));
  EXPECT_FALSE(found.contains("stirring(hand, spoon, bowl)"));
}

TEST(MotionInHands, CarryingSpoonAndBowlToAndFroIsNoStirring) {
  const auto found = Stirred(
      Stirring(), [](double) { return Vector3d(0, 0, 0); },
      [](double s) { return Vector3d((Smooth(s, 2, 2.2) - Smooth(s, 6.8, 7)) * ToAndFro(s)); });
  ASSERT_TRUE(found.contains("grasping(hand, spoon)"));
  EXPECT_FALSE(found.contains("stirring(hand, spoon, bowl)"));
}

/// A hand is 25 cm beside a heavy crate, comes to `gap_m` from it at 1.0 s, leaves at 3.0 s.
std::vector<Span> GraspsOfWhatStays(double gap_m, double from_m = 0.25) {
  const auto found = Recognise(
      testing::CompileLibrary("pick_and_place_from_motion"),
      {Thing("crate", {0.1, 0.1, 0.1}), Hand("hand")}, 4, [&](double s) {
        const double away_m = from_m - gap_m;
        const double x_m = 0.1 + gap_m + away_m * (1 - Smooth(s, 0.4, 1) + Smooth(s, 3, 3.6));
        return std::vector<Pose>{{Vector3d(0, 0, 0.1)}, {Vector3d(x_m, 0, 0.1)}};
      });
  return found.contains("grasping(hand, crate)") ? found.at("grasping(hand, crate)")
                                                 : std::vector<Span>{};
}

TEST(MotionInHands, AHandThatComesStaysAndLeavesHeldItStill) {
  ExpectSpans(GraspsOfWhatStays(0.06), {{1, 3}}, 0.1);
}

TEST(MotionInHands, AHandThatStaysFartherAwayHoldsNothing) {
  EXPECT_TRUE(GraspsOfWhatStays(0.12).empty());
}

TEST(MotionInHands, AHandThatWasThereHoldsNothing) {
  EXPECT_TRUE(GraspsOfWhatStays(0.06, 0.068).empty());
}

// The hand touches a box, waits for 1.5 s, and lifts it at 2.5 s.
TEST(MotionInHands, ARestBeforeTheLiftIsNoGrasp) {
  const auto found =
      Recognise(testing::CompileLibrary("pick_and_place_from_motion"),
                {Thing("box", {0.05, 0.05, 0.05}), Hand("hand")}, 5, [&](double s) {
                  const Vector3d box(0, 0, 0.05 + 0.3 * (Smooth(s, 2.5, 3.1)));
                  return std::vector<Pose>{
                      {box}, {box + Vector3d(0.07 + 0.4 * (1 - Smooth(s, 0.3, 1)), 0, 0)}};
                });
  ASSERT_TRUE(found.contains("grasping(hand, box)"));
  ExpectSpans(found.at("grasping(hand, box)"), {{2.5, 5}}, 0.1);
}

// The hand lies still. For a frame its tracker is 4 cm off.
TEST(MotionInHands, AnErrorOfAFrameIsNoParting) {
  const auto found =
      Recognise(testing::CompileLibrary("pick_and_place_from_motion"),
                {Thing("box", {0.05, 0.05, 0.05}), Hand("hand")}, 5, [&](double s) {
                  const Vector3d box(0.3 * Smooth(s, 2.6, 3.4), 0, 0.05);
                  const double off_m = s > 3.9 && s < 3.91 ? 0.04 : 0;
                  const Vector3d away(0.4 * (1 - Smooth(s, 0.3, 1) + Smooth(s, 4.3, 4.9)), 0, 0);
                  return std::vector<Pose>{{box}, {box + away + Vector3d(0.07 + off_m, 0, 0)}};
                });
  ASSERT_TRUE(found.contains("grasping(hand, box)"));
  ExpectSpans(found.at("grasping(hand, box)"), {{2.7, 4.4}}, 0.15);
}

/// Two hands at a bowl: a whisk, whose orientation counts from lying, stirs in it from 2 to 7 s,
/// tipped by 70 degrees. A bottle is tipped by 110 degrees over it from 3.5 to 5.5 s, and shaken.
std::map<std::string, std::vector<Span>> StirredAndPouredInto() {
  return Recognise(
      Compiled("use contact from motion\nuse stirring from motion\nuse pouring from motion\n"),
      {Thing("whisk", {0.02, 0.02, 0.1}), Thing("bottle", {0.04, 0.04, 0.12}),
       Thing("bowl", {0.1, 0.1, 0.05}), Hand("left"), Hand("right")},
      9, [&](double s) {
        const double used = Smooth(s, 1.3, 1.9) - Smooth(s, 7.1, 7.7);
        const double round = 2 * std::numbers::pi * 1.3 * s;
        const double stirs = Smooth(s, 1.9, 2.1) - Smooth(s, 6.8, 7);
        const Vector3d whisk = Vector3d(0.4 * (1 - used), 0, 0.1 + 0.1 * used) +
                               0.03 * stirs * Vector3d(std::sin(round), std::cos(round), 0);
        const Quaterniond leaning(Eigen::AngleAxisd(1.22 * used, Vector3d::UnitX()));
        const double there = Smooth(s, 2.8, 3.5) - Smooth(s, 5.6, 6.3);
        const double shakes = 0.02 * std::sin(2 * std::numbers::pi * 2 * s) *
                              (Smooth(s, 3.5, 3.6) - Smooth(s, 5.4, 5.5));
        const Vector3d bottle(-0.4 + 0.3 * there + shakes, 0.02 * there, 0.12 + 0.15 * there);
        const double tip = 1.92 * (Smooth(s, 3.3, 3.7) - Smooth(s, 5.3, 5.7));
        const Quaterniond tipped(Eigen::AngleAxisd(tip, Vector3d::UnitY()));
        const Vector3d away(0, 0.4 * (1 - Smooth(s, 0, 0.8) + Smooth(s, 8, 8.7)), 0);
        return std::vector<Pose>{{whisk, leaning},
                                 {bottle, tipped},
                                 {Vector3d(0, 0, 0.05)},
                                 {bottle + Vector3d(-0.07, 0, 0) - away, tipped},
                                 {whisk + Vector3d(0.05, 0, 0.05) + away, leaning}};
      });
}

TEST(MotionInHands, WhatStirsDoesNotPourAndWhatPoursDoesNotStir) {
  const auto found = StirredAndPouredInto();
  ASSERT_TRUE(found.contains("stirring(right, whisk, bowl)"));
  ExpectSpans(found.at("stirring(right, whisk, bowl)"), {{2, 7}}, 0.5);
  ASSERT_TRUE(found.contains("pouring(left, bottle, bowl)"));
  ExpectSpans(found.at("pouring(left, bottle, bowl)"), {{3.5, 5.6}}, 0.3);
  for (const auto& [event, spans] : found)
    EXPECT_TRUE(!event.starts_with("stirring") || event == "stirring(right, whisk, bowl)") << event;
  for (const auto& [event, spans] : found)
    EXPECT_TRUE(!event.starts_with("pouring") || event == "pouring(left, bottle, bowl)") << event;
}

// The same hands, from the first to the last frame: each does one thing at a time.
TEST(MotionInHands, EachHandHasItsActions) {
  const auto found =
      Recognise(testing::CompileLibrary("hand_actions_from_motion"),
                {Thing("box", {0.05, 0.05, 0.05}), Hand("hand")}, 8, [&](double s) {
                  const Vector3d box(0.3 * (Smooth(s, 2, 2.8) + Smooth(s, 4, 4.8)), 0,
                                     0.05 + 0.2 * (Smooth(s, 2, 2.6) - Smooth(s, 4.2, 4.8)));
                  const Vector3d away(0, 0.4 * (1 - Smooth(s, 1, 1.9) + Smooth(s, 5, 5.8)), 0);
                  return std::vector<Pose>{{box}, {box + Vector3d(0, 0.07, 0) + away}};
                });
  const std::map<std::string, Span> wanted = {{"going_to(hand, box)", {1, 2}},
                                              {"lifting(hand, box)", {2, 2.8}},
                                              {"holding(hand, box)", {2.8, 4}},
                                              {"placing(hand, box)", {4, 5}},
                                              {"retreating(hand, box)", {5, 5.8}}};
  for (const auto& [action, span] : wanted) {
    ASSERT_TRUE(found.contains(action)) << action;
    ASSERT_EQ(found.at(action).size(), 1) << action;
    EXPECT_NEAR(found.at(action)[0].first, span.first, 0.15) << action;
    EXPECT_NEAR(found.at(action)[0].second, span.second, 0.15) << action;
  }
  ASSERT_TRUE(found.contains("idling(hand)"));
  ExpectSpans(found.at("idling(hand)"), {{0, 1}, {5.8, 8}}, 0.15);
}

}  // namespace
}  // namespace prehend::grammar
