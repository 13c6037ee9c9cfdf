// SPDX-License-Identifier: Apache-2.0
// Of what is not tracked, no condition holds, and neither does its opposite; what held ends there.
#include "grammar/base/frame.h"
#include "grammar/base/solid.h"
#include "grammar/name_events.h"
#include "grammar/state/instances.h"
#include "tests/grammar/scene.h"

namespace prehend::grammar {
namespace {

using testing::CompileText;
using testing::Scene;

/// Intervals of the only event, "begin..end; ": 100 frames of 10 ms, in which these are not tracked
/// from 300 to 500 ms.
std::string Held(const std::string& grammar, const std::vector<int>& lost) {
  const auto program = CompileText(grammar);
  if (!program) return "";
  Scene scene;
  scene.entity_table.entities[Scene::kCup].half_size_m = {0.05, 0.05, 0.05};
  scene.entity_table.entities[Scene::kCup].solid = Solid({{.shape = Box{{0.05, 0.05, 0.05}}}});
  scene.entity_table.entities[Scene::kTray].half_size_m = {0.5, 0.5, 0.5};
  const std::vector<EntitySample> all = scene.looks;
  Monitor monitor(program, scene.entity_table);
  std::vector<Event> events;
  for (Tick tick = 0; tick < 1000; tick += 10) {
    scene.looks = all;
    if (tick >= 300 && tick < 500) {
      for (const int entity : lost) scene.looks[static_cast<std::size_t>(entity)] = NotTracked();
    }
    Touch stands{.a = Scene::kCup, .b = Scene::kTray, .up_on_a = 1};
    stands.vertical_speed_m_per_s = SpeedAtTheUpper(stands, scene.looks[1], scene.looks[2]);
    scene.touches = {stands};
    monitor.Advance(scene.At(tick), events);
  }
  monitor.Finish(1000, events);
  EXPECT_EQ(monitor.error(), "");
  std::string text;
  for (const Event& event : events)
    text += std::to_string(event.interval.begin) + ".." + std::to_string(event.interval.end) + "; ";
  return text;
}

std::string While(const std::string& condition) {
  return "grammar t\nevent e(hand: Hand, cup: Cup, tray: Movable) while part_of(cup, tray) and "
         "height(hand) < 100 m and (" +
         condition + ")\n";
}

TEST(NotTracked, WhatIsLostIsAsItWasInTheFrameBefore) {
  EntitySample lost = NotTracked();
  EXPECT_TRUE(SameFacts(lost, NotTracked()));
  EXPECT_FALSE(SameFacts(lost, {}));
  EXPECT_FALSE(SameFacts({}, lost));
  lost.gazes_at = 1;
  EXPECT_FALSE(SameFacts(lost, NotTracked()));
  lost = NotTracked();
  lost.joint_position = 0.5;  // somebody else measures it
  EXPECT_FALSE(SameFacts(lost, NotTracked()));
  TouchSample stands{.frame = 1, .up = {1, -1}, .vertical_speed_m_per_s = kNotKnown};
  EXPECT_TRUE(stands.Says({.frame = 2, .up = {1, -1}, .vertical_speed_m_per_s = kNotKnown}));
  EXPECT_FALSE(stands.Says({.frame = 2, .up = {1, -1}}));
  EXPECT_FALSE(stands.Says({.frame = 2, .vertical_speed_m_per_s = kNotKnown}));
}

TEST(NotTracked, NeitherAConditionNorItsOppositeHolds) {
  // All of it is about the cup, which is where hand and tray are, at rest.
  const char* conditions[] = {"distance(hand, cup) < 1 m",
                              "height(cup) < 1 m",
                              "speed(cup) < 1 m/s",
                              "vertical_speed(cup) < 1 m/s",
                              "relative_speed(cup, hand) < 1 m/s",
                              "tilt(cup) < 1 rad",
                              "gap(hand, cup) < 1 m",
                              "clearance(cup, tray) < 5 m",
                              "joint_fraction(cup) < 0.5",
                              "distance(hand, cup) + 1 m < 3 m",
                              "1 m - abs(height(cup)) > 0 m",
                              "in_sphere(cup, position(hand), 1 m)",
                              "in_sphere(position(hand), position(cup), 1 m)",
                              "inside(cup, tray)",
                              "touch_speed(cup, tray) < 1 m/s",
                              "touch_speed(cup, tray) + 1 m/s < 2 m/s",
                              "speed_along(cup, tray) < 1 m/s",
                              "height(cup) == 0 m"};
  for (const std::string condition : conditions) {
    EXPECT_EQ(Held(While(condition), {Scene::kCup}), "0..300; 500..1000; ") << condition;
    EXPECT_EQ(Held(While("not (not (" + condition + "))"), {Scene::kCup}), "0..300; 500..1000; ")
        << condition;
    EXPECT_EQ(Held(While("not (" + condition + ")"), {Scene::kCup}), "") << condition;
    EXPECT_EQ(Held(While(condition), {}), "0..1000; ") << condition;
  }
  for (const std::string condition :
       {"not (height(cup) > 1 m)", "not (tilt(cup) > 1 rad)", "height(cup) != 1 m"})
    EXPECT_EQ(Held(While(condition), {Scene::kCup}), "0..300; 500..1000; ") << condition;
}

/// A bound that no value misses is a warning, and still unknown where there is no value.
TEST(NotTracked, WhatEveryValueSatisfiesIsUnknownWithoutOne) {
  for (const std::string condition :
       {"touch_speed(cup, tray) >= 0 m/s", "touch_speed(cup, tray) > -1 m/s", "speed(cup) >= 0 m/s",
        "distance(hand, cup) > -1 m", "tilt(cup) <= 180 deg", "abs(height(cup)) >= 0 m",
        "height(cup) == height(cup)", "not (speed(cup) < 0 m/s)", "gap(hand, cup) != -1 m",
        "known speed(cup) >= 0 m/s", "known (touch_speed(cup, tray) >= 0 m/s)"}) {
    EXPECT_EQ(Held(While(condition), {Scene::kCup}), "0..300; 500..1000; ") << condition;
    EXPECT_EQ(Held(While(condition), {}), "0..1000; ") << condition;
  }
  EXPECT_EQ(
      Held("grammar t\nevent e(cup: Cup) while not known speed(cup) >= 0 m/s\n", {Scene::kCup}),
      "300..500; ");
  EXPECT_EQ(Held("grammar t\ndefine fast(cup: Cup, v: m/s) = speed(cup) >= v\n"
                 "event e(cup: Cup) while fast(cup, 0 m/s)\n",
                 {Scene::kCup}),
            "0..300; 500..1000; ");
}

TEST(NotTracked, WindowsThatReachIntoTheGapHaveNoValueEither) {
  for (const std::string signal : {"mean(height(cup), 100 ms)", "min(height(cup), 100 ms)",
                                   "max(height(cup), 100 ms)", "median(height(cup), 100 ms)"}) {
    EXPECT_EQ(Held(While(signal + " < 1 m"), {Scene::kCup}), "0..250; 550..1000; ") << signal;
    EXPECT_EQ(Held(While("not (" + signal + " > 1 m)"), {Scene::kCup}), "0..250; 550..1000; ");
  }
  // These look at both ends of their window.
  for (const std::string condition :
       {"rate(height(cup), 100 ms) < 1 m/s", "speed(cup, 100 ms) < 1 m/s"})
    EXPECT_EQ(Held(While(condition), {Scene::kCup}), "0..250; 550..1000; ") << condition;
  // Nor do those in which both ends are seen.
  for (const std::string signal :
       {"rate(height(cup), 400 ms) < 1 m/s", "speed(cup, 400 ms) < 1 m/s",
        "relative_speed(cup, hand, 400 ms) < 1 m/s", "spin(cup, z, 400 ms) < 1 rad/s",
        "turn_rate(cup, hand, 400 ms) < 1 rad/s", "drift_along(cup, hand, 400 ms) < 1 m/s"})
    EXPECT_EQ(Held(While(signal), {Scene::kCup}), "0..100; 700..1000; ") << signal;
}

TEST(NotTracked, EitherOneOfTwoIsEnough) {
  for (const int lost : {Scene::kHand, Scene::kCup})
    EXPECT_EQ(Held(While("gap(hand, cup) < 1 m and distance(cup, hand) < 1 m"), {lost}),
              "0..300; 500..1000; ");
  EXPECT_EQ(Held(While("not (in_sphere(cup, position(hand), 1 m))"), {Scene::kHand}), "");
  EXPECT_EQ(Held(While("distance(hand, cup) < 1 m or height(tray) < 1 m"), {Scene::kCup}),
            "0..1000; ");
  EXPECT_EQ(Held(While("not (distance(hand, cup) < 1 m and height(tray) < 1 m)"), {Scene::kCup}),
            "");
}

TEST(NotTracked, AShortGapMayBeBridgedByARuleAndItsBeginIsAnEnd) {
  EXPECT_EQ(
      Held("grammar t\nevent e(cup: Cup) while height(cup) < 1 m bridging 300 ms\n", {Scene::kCup}),
      "0..1000; ");
  EXPECT_EQ(Held("grammar t\nevent e(cup: Cup) from height(cup) < 1 m ends to height(cup) < 1 m "
                 "begins\n",
                 {Scene::kCup}),
            "300..500; ");
}

// From when the hand is low, which it always is, nobody sees whether the cup rises while it is
// lost.
TEST(NotTracked, AbsenceNeedsSight) {
  const std::string high = "grammar t\ncondition high(cup: Cup) while height(cup) > 5 m\n";
  const std::string roles = "event e(hand: Hand, cup: Cup) from height(hand) < 1 m begins without ";
  for (const std::string comes : {"high(cup) begins", "height(cup) > 5 m begins",
                                  "(height(cup) > height(cup)@begin + 5 m or high(cup)) begins"}) {
    const std::string rule = high + roles + comes;
    EXPECT_EQ(Held(rule + " within 250 ms\n", {Scene::kCup}), "0..250; ") << comes;
    EXPECT_EQ(Held(rule + " within 300 ms\n", {Scene::kCup}), "0..300; ") << comes;
    EXPECT_EQ(Held(rule + " within 310 ms\n", {Scene::kCup}), "") << comes;
    EXPECT_EQ(Held(rule + " within 310 ms\n", {}), "0..310; ") << comes;
    EXPECT_EQ(Held(rule + " within 310 ms\n", {Scene::kTray}), "0..310; ") << comes;
  }
  // Touches are facts of their own.
  EXPECT_EQ(Held(high + roles + "touching(hand, cup) begins within 310 ms\n", {Scene::kCup}),
            "0..310; ");
}

// Somebody who sees a rule by their pose is lost: where it is not recognised it is unknown.
TEST(NotTracked, ARuleIsUnknownOutOfSightForThoseWhoAskWhatIsKnown) {
  const std::string rules =
      "grammar t\ncondition high(cup: Cup) while height(cup) > 5 m\n"
      "condition low(cup: Cup) while height(cup) < 5 m bridging 1 s\n"
      "condition calm(cup: Cup) while not high(cup)\n"
      "condition far(hand: Hand, cup: Cup) while distance(hand, cup) > 5 m\n"
      "condition felt(hand: Hand, cup: Cup) while touching(hand, cup)\n"
      "event e(hand: Hand, cup: Cup) while height(hand) < 1 m and ";
  const std::string always = "0..1000; ", seen = "0..300; 500..1000; ", lost = "300..500; ";
  const std::pair<std::string, std::string> cases[] = {
      {"not high(cup)", always},
      {"known not high(cup)", seen},
      {"known not not not high(cup)", seen},
      {"not known not high(cup)", lost},
      {"not known high(cup) and not known not high(cup)", lost},
      {"known not (high(cup) or felt(hand, cup))", seen},
      {"known not (high(cup) and felt(hand, cup))", always},
      {"known (not high(cup) or low(cup))", always},
      {"known low(cup)", always},
      {"known not calm(cup)", ""},
      {"known not felt(hand, cup)", always},
      {"known not (height(cup) > 5 m)", seen},
      {"known not far(hand, any) and not felt(hand, cup)", always},  // who plays `any` is not named
      {"not known height(cup) < 5 m", lost},
      {"known not known high(cup)", always}};
  for (const auto& [condition, held] : cases) {
    EXPECT_EQ(Held(rules + condition + "\n", {Scene::kCup}), held) << condition;
    EXPECT_EQ(Held(rules + condition + "\n", {}), held == lost   ? ""
                                                  : held == seen ? always
                                                                 : held)
        << condition;
  }
  const std::string from = rules.substr(0, rules.find("event")) + "event e(cup: Cup) ";
  EXPECT_EQ(
      Held(from + "from known not high(cup) begins to known not high(cup) ends\n", {Scene::kCup}),
      seen);
  EXPECT_EQ(Held(from + "while low(cup) requires known not high(cup)\n", {Scene::kCup}), always);
}

// As far as its windows reach, one in another.
TEST(NotTracked, ARuleIsOutOfSightInTheWholeWindowThatItLooksAt) {
  const std::string rules =
      "grammar t\ncondition fast(cup: Cup) while speed(cup, 100 ms) > 5 m/s\n"
      "condition faster(cup: Cup) while median(speed(cup, 100 ms), 60 ms) > 5 m/s\n"
      "condition moved(hand: Hand, cup: Cup) while fast(cup) and touching(hand, cup)\n"
      "event e(hand: Hand, cup: Cup) ";
  const std::pair<std::string, std::string> cases[] = {
      {"while height(hand) < 1 m and known not fast(cup)", "0..250; 550..1000; "},
      {"while height(hand) < 1 m and known not faster(cup)", "0..220; 580..1000; "},
      {"while height(hand) < 1 m and known not moved(hand, cup)", "0..250; 550..1000; "},
      {"while height(hand) < 1 m and not known not fast(cup)", "250..550; "},
      {"from height(hand) < 1 m begins without fast(cup) begins within 250 ms", "0..250; "},
      {"from height(hand) < 1 m begins without fast(cup) begins within 260 ms", ""},
      {"from height(hand) < 1 m begins without speed(cup, 100 ms) > 5 m/s begins within 260 ms",
       ""}};
  for (const auto& [form, held] : cases)
    EXPECT_EQ(Held(rules + form + "\n", {Scene::kCup}), held) << form;
  const std::string between =
      "grammar t\ncondition fast(cup: Cup) while speed(cup, 100 ms) > 5 m/s\n"
      "condition soon(tray: Movable) from height(tray) < 1 m begins without height(tray) > 5 m "
      "begins within 50 ms\n"
      "event e(cup: Cup, tray: Movable) compose a: soon(tray), b: soon(tray) where a before b, "
      "without fast(cup) between a and b\n";
  EXPECT_EQ(Held(between, {Scene::kTray}), "0..550; ");
}

// Cup and tray are where the hand is, the cup first in the cast.
TEST(NotTracked, WhoIsLostIsNotTheNearest) {
  const std::string rules =
      "grammar t\ncondition sees(hand: Hand, cup: Cup) while distance(hand, cup) < 1 m\n"
      "condition lost(hand: Hand) from sees(hand, any) ends to height(hand) > 5 m begins\n"
      "condition has(thing: Movable, hand: Hand) while ";
  const std::string whose = "event e(thing: Movable, hand: Hand) while has(thing, hand) and ";
  for (const std::string one :
       {" one thing per hand\n", " one thing per hand, nearest within 50 ms\n"}) {
    const std::string now = rules + "not sees(hand, any)" + one + whose;
    EXPECT_EQ(Held(now + "is(thing, Cup)", {Scene::kCup}), "") << one;
    EXPECT_EQ(Held(now + "not is(thing, Cup)", {Scene::kCup}), "300..500; ") << one;
    EXPECT_EQ(Held(now + "not is(thing, Dog)", {Scene::kHand}), "") << one;
    EXPECT_EQ(Held(now + "not is(thing, Dog)", {Scene::kCup, Scene::kTray}), "") << one;
    const std::string on = rules + "lost(hand)" + one + whose;  // from 300 on
    EXPECT_EQ(Held(on + "is(thing, Cup)", {Scene::kHand}), "500..1000; ") << one;
    EXPECT_EQ(Held(on + "not is(thing, Cup)", {Scene::kHand}), "") << one;
    // Who is alone need not be the nearest.
    const std::string alone = rules + "lost(hand) and is(thing, Cup)" + one + whose;
    EXPECT_EQ(Held(alone + "is(thing, Cup)", {Scene::kCup}), "300..1000; ") << one;
  }
}

TEST(NotTracked, NothingIsBetweenOnlyIfItIsSeen) {
  const std::string rules =
      "grammar t\ncondition high(cup: Cup) while height(cup) > 5 m\n"
      "condition low(hand: Hand) from height(hand) < 1 m begins without height(hand) > 5 m begins "
      "within 50 ms\n"
      "condition seen(tray: Movable) from height(tray) < 1 m begins without height(tray) > 5 m "
      "begins "
      "within 50 ms\n"
      "event e(hand: Hand, cup: Cup, tray: Movable)\n"
      "  compose a: low(hand), b: seen(tray), c: seen(cup) where a before b, ";
  const std::string equal = "b equals c";
  EXPECT_EQ(Held(rules + equal + "\n", {Scene::kTray, Scene::kCup}), "0..550; ");
  EXPECT_EQ(
      Held(rules + equal + ", without high(cup) between a and b\n", {Scene::kTray, Scene::kCup}),
      "");
  // What is there all the time ends with its first interval.
  const std::string seen =
      "grammar t\ncondition high(cup: Cup) while height(cup) > 5 m\n"
      "condition seen(tray: Movable) from height(tray) < 1 m begins without height(tray) > 5 m "
      "begins "
      "within 50 ms\n"
      "event e(cup: Cup, tray: Movable)\n"
      "  all of a: seen(tray), b: seen(tray) where a before b, without high(cup) between a and b "
      "within 2 s\n";
  EXPECT_EQ(Held(seen, {Scene::kTray}), "0..550; ");
  EXPECT_EQ(Held(seen, {Scene::kTray, Scene::kCup}), "");
}

TEST(NotTracked, AValueThatNobodyKnowsIsLeftOut) {
  const auto program = CompileText(
      "grammar t\nevent e(hand: Hand, cup: Cup) while touching(hand, cup) or height(hand) < 1 m "
      "with low = height(hand) with up = height(cup)\n");
  ASSERT_TRUE(program);
  Scene scene;
  Monitor monitor(program, scene.entity_table);
  scene.looks[Scene::kCup] = NotTracked();
  std::vector<Event> events;
  monitor.Advance(scene.At(0), events);
  monitor.Finish(10, events);
  const Timeline timeline = NameEvents(*program, scene.entity_table, events);
  ASSERT_EQ(timeline.events.size(), 1U);
  ASSERT_EQ(timeline.events[0].values.size(), 1U);
  EXPECT_EQ(timeline.events[0].values[0].name, "low");
}

TEST(NotTracked, OnlyWhatIsTrackedIsNearest) {
  const std::string nearest =
      "grammar t\nevent e(thing: Thing, hand: Hand) while nearest(thing, hand)\n";
  // Cup and tray are both there; of two that are equally near, the first one is.
  EXPECT_EQ(Held(nearest, {Scene::kCup}), "0..300; 300..500; 500..1000; ");
  EXPECT_EQ(Held(nearest, {Scene::kHand}), "0..300; 500..1000; ");
}

}  // namespace
}  // namespace prehend::grammar
