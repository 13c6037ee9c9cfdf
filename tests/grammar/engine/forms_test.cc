// SPDX-License-Identifier: Apache-2.0
// Deadlines, attributes, definitions and sensor sets on frames written by hand;
// tests/grammar/reference/reference_test.cc has the meaning of the forms on many streams.
#include <algorithm>

#include "tests/grammar/scene.h"

namespace prehend::grammar {
namespace {

using testing::Scene;

std::vector<Event> WatchTouch(const std::string& text, const std::vector<Tick>& ticks,
                              Tick touch_until) {
  Scene scene;
  scene.touches = {
      {.a = Scene::kHand, .b = Scene::kCup, .normal_force_n = 3, .sensor_sets = 0b101}};
  Monitor monitor(testing::CompileText("grammar t\n" + text), scene.entity_table);
  std::vector<Event> events;
  for (const Tick tick : ticks) {
    scene.looks[Scene::kCup].p_WB_m.z() = static_cast<double>(tick) / 1000;
    if (tick >= touch_until) scene.touches.clear();
    monitor.Advance(scene.At(tick), events);
  }
  monitor.Finish(100, events);
  EXPECT_EQ(monitor.error(), "");
  return events;
}

constexpr const char* kMissed =
    "event missed(h: Hand, c: Cup) from touching(h, c) begins without touching(h, c) ends within "
    "25 ms";

TEST(Forms, ADeadlineBetweenTwoFramesDecidesAtItself) {
  const std::vector<Event> events = WatchTouch(kMissed, {0, 10, 20, 40}, 90);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].interval, (Interval{0, 25}));
  EXPECT_EQ(events[0].decided, 25);
}

TEST(Forms, ADeadlineThatPassesBeforeTheEndOfTheEpisodeCounts) {
  EXPECT_EQ(WatchTouch(kMissed, {0, 10}, 90).size(), 1u);
  EXPECT_EQ(WatchTouch("event missed(h: Hand, c: Cup) from touching(h, c) begins without "
                       "touching(h, c) ends within 101 ms",
                       {0, 10}, 90)
                .size(),
            0u);
}

TEST(Forms, WhatComesAtTheDeadlineIsInTime) {
  EXPECT_EQ(WatchTouch(kMissed, {0, 10, 25}, 25).size(), 0u);
  EXPECT_EQ(WatchTouch(kMissed, {0, 10, 26}, 26).size(), 1u);
}

// A frame each 10 ticks, touched in two of them: `let_go` ends between frames, and what is made of
// it ends there, too.
TEST(Forms, WhatIsMadeOfAnAbsenceEndsWithIt) {
  const std::string let_go =
      "condition let_go(h: Hand, c: Cup) from touching(h, c) ends without touching(h, c) begins "
      "within 15 ms\ncondition never(h: Hand, c: Cup) while touching(h, c) and height(c) > 9 m\n"
      "event e(h: Hand, c: Cup) ";
  const auto found = [&](const std::string& form, Tick end) {
    Scene scene;
    Monitor monitor(testing::CompileText("grammar t\n" + let_go + form), scene.entity_table);
    std::vector<Event> events;
    for (Tick tick = 0; tick < end; tick += 10) {
      scene.touches.clear();
      if (tick == 10 || tick == 50) scene.touches = {{.a = Scene::kHand, .b = Scene::kCup}};
      monitor.Advance(scene.At(tick), events);
    }
    monitor.Finish(200, events);
    std::string text;
    for (const Event& event : events)
      text += "[" + std::to_string(event.interval.begin) + "," +
              std::to_string(event.interval.end) + (event.open_end ? ".. " : ") ");
    return text;
  };
  const std::string both = "[20,35) [60,75) ";
  for (const Tick end : {70, 100}) {  // 70: the second one ends after the last frame
    EXPECT_EQ(found("rest of let_go(h, c) outside never(h, c)", end), both);
    EXPECT_EQ(found("rest of let_go(h, c) outside never(h, c) lasting 1 ms to 15 ms", end), both);
    EXPECT_EQ(found("repeat let_go(h, c) at least 1, gap at most 24 ms", end), both);
    EXPECT_EQ(found("repeat let_go(h, c) at least 2, gap at most 24 ms", end), "");
    EXPECT_EQ(found("repeat let_go(h, c) at least 2, gap at most 25 ms", end), "[20,75) ");
  }
}

// A drum is touched in these intervals of ticks; a frame each tick. Each event as "[0,5)@7 x3".
std::string Drummed(const std::string& text, const std::vector<Interval>& touches) {
  Scene scene;
  const auto program = testing::CompileText("grammar t\n" + text);
  Monitor monitor(program, scene.entity_table);
  std::vector<Event> events;
  for (Tick tick = 0; tick < 100; ++tick) {
    scene.touches.clear();
    for (const Interval& touch : touches) {
      if (touch.begin <= tick && tick < touch.end)
        scene.touches = {{.a = Scene::kHand, .b = Scene::kCup}};
    }
    monitor.Advance(scene.At(tick), events);
  }
  monitor.Finish(100, events);
  std::string found;
  for (const Event& event : events) {
    if (program->rules[event.rule].name != "e") continue;
    found += "[" + std::to_string(event.interval.begin) + "," + std::to_string(event.interval.end) +
             ")@" + std::to_string(event.decided) + " x" +
             std::to_string(static_cast<int>(event.attributes[0])) + " ";
  }
  return found;
}

// One binding of a symmetric event is one, whichever way round its classes are named, and again
// after it has rested.
TEST(Forms, APairOfNamedClassesIsCountedOnce) {
  const auto found = [](const std::string& counted) {
    Scene scene;
    scene.entity_table.entities[Scene::kTray].classes.push_back("Tray");
    const std::shared_ptr<const Program> program = testing::CompileText(
        "grammar t\nsymmetric event both(a: Movable, b: Movable, h: Hand) while touching(a, h) and "
        "touching(b, h)\nevent e(h: Hand) while " +
        counted);
    Monitor monitor(program, scene.entity_table);
    std::vector<Event> events;
    for (Tick tick = 0; tick < 1000; tick += 10) {
      scene.touches = {{.a = Scene::kHand, .b = Scene::kCup}};
      if (tick % 300 >= 200) scene.touches.push_back({.a = Scene::kHand, .b = Scene::kTray});
      monitor.Advance(scene.At(tick), events);
    }
    monitor.Finish(1000, events);
    return std::ranges::count_if(
        events, [&](const Event& event) { return program->rules[event.rule].name == "e"; });
  };
  for (const std::string pair :
       {"any, any", "any, any Movable", "any Movable, any", "any Tray, any", "any, any Tray"}) {
    EXPECT_EQ(found("at least 1 of both(" + pair + ", h)"), 3) << pair;
    EXPECT_EQ(found("at least 2 of both(" + pair + ", h)"), 0) << pair;
    EXPECT_EQ(found("known at least 2 of both(" + pair + ", h)"), 0) << pair;
  }
}

TEST(Forms, RepeatCountsWhatFollowsInTime) {
  const std::string thrice =
      "event e(h: Hand, c: Cup) repeat touching(h, c) at least 3, gap at most 5 ms with n = count";
  EXPECT_EQ(Drummed(thrice, {{2, 4}, {9, 10}, {15, 16}}), "[2,16)@21 x3 ");
  EXPECT_EQ(Drummed(thrice, {{2, 4}, {9, 10}, {16, 17}}), "") << "the second gap is too long";
  EXPECT_EQ(Drummed(thrice, {{2, 4}, {10, 11}, {12, 13}, {14, 15}, {16, 99}}), "[10,99)@100 x4 ");
  EXPECT_EQ(Drummed(thrice + " requires count <= 3", {{2, 3}, {4, 5}, {6, 7}, {8, 9}}), "");
  EXPECT_EQ(Drummed(thrice, {{2, 3}, {4, 5}, {96, 97}, {98, 100}}), "");
}

// Who asks for what is repeated knows of it as soon as there are enough, not where the last one
// ends.
// It rests in the gap, wakes, and must wait for another one to know whether it goes on.
TEST(Forms, WhoRestsInAGapRemembersWhereItBegan) {
  Scene scene;
  const auto program = testing::CompileText(
      "grammar t\ncondition firm(hand: Hand, cup: Cup) while touching(hand, cup) lasting 30 ms\n"
      "event e(hand: Hand, cup: Cup, tray: Movable) while firm(hand, cup) and height(hand) < 9 m "
      "and touching(hand, tray) bridging 80 ms requires height(cup) < 9 m\n");
  Monitor monitor(program, scene.entity_table);
  std::vector<Event> events;
  for (Tick tick = 0; tick < 300; tick += 2) {
    scene.touches.clear();
    if (tick < 40 || (tick >= 100 && tick < 150)) {
      for (const int whom : {Scene::kCup, Scene::kTray})
        scene.touches.push_back({.a = Scene::kHand, .b = whom});
    }
    monitor.Advance(scene.At(tick), events);
  }
  monitor.Finish(300, events);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].interval, (Interval{0, 150}));
}

TEST(Forms, WhatIsTooLateForOneMayBeInTimeForTheNext) {
  const std::string rule =
      "condition tap(hand: Hand, tray: Movable) while touching(hand, tray)\n"
      "event e(hand: Hand, tray: Movable) from each tap(hand, tray) begins to "
      "not touching(hand, tray) begins within 10 ms\n";
  EXPECT_EQ(Drummed(rule, {{10, 15}}), "[10,15)@15 x0 ");
  EXPECT_EQ(Drummed(rule, {{10, 21}}), "");
  const std::string answered =
      "condition tap(hand: Hand, tray: Movable) while touching(hand, tray) lasting 0 ms to 3 ms\n"
      "condition press(hand: Hand, tray: Movable) while touching(hand, tray) lasting 5 ms\n"
      "event e(hand: Hand, tray: Movable) from ";
  const std::string to = "tap(hand, tray) ends to press(hand, tray) begins within 10 ms\n";
  const std::vector<Interval> touches = {{10, 12}, {18, 20}, {22, 24}, {29, 40}};
  EXPECT_EQ(Drummed(answered + to, touches), "[24,29)@33 x0 ");
  EXPECT_EQ(Drummed(answered + "each " + to, touches), "[20,29)@33 x0 ");
  EXPECT_EQ(Drummed(answered + "each " + to, {{10, 12}, {18, 20}}), "");
  EXPECT_EQ(Drummed(answered + "each " + to, {{10, 12}, {80, 82}, {93, 95}}), "[95,100)@100 x0 ");
  EXPECT_EQ(Drummed(answered + "each " + to.substr(0, to.size() - 1) +
                        " during not touching(hand, tray) or drop\n",
                    touches),
            "[24,29)@33 x0 ");
}

// At 22 the one from 12 on lasts too long; it is not known that nothing holds since 20, which
// waits.
TEST(Forms, WhatIsTooLongIsNoneButWhatWaitsMayBeOne) {
  const std::string text =
      "condition tap(hand: Hand, tray: Movable) while touching(hand, tray) lasting 0 ms to 3 ms\n"
      "condition press(hand: Hand, tray: Movable) while touching(hand, tray) lasting 5 ms\n"
      "condition answered(hand: Hand, tray: Movable) from each tap(hand, tray) ends to "
      "press(hand, tray) begins within 10 ms lasting 0 ms to 9 ms\n"
      "event e(hand: Hand, tray: Movable) while not answered(hand, tray) lasting 0 ms to 30 ms\n";
  EXPECT_EQ(Drummed(text, {{10, 12}, {18, 20}, {29, 40}}), "[0,20)@33 x0 ");
}

TEST(Forms, RepeatIsKnownWhenThereAreEnough) {
  const std::string text =
      "condition thrice(h: Hand, c: Cup) repeat touching(h, c) at least 3, gap at most 5 ms\n"
      "event e(h: Hand, c: Cup) from touching(h, c) ends to thrice(h, c) ends\n"
      "  during thrice(h, c) with n = 0\n"
      "condition brief(h: Hand, c: Cup) while touching(h, c) lasting 1 ms to 9 ms\n"
      "event f(h: Hand, c: Cup) while brief(h, c)";
  EXPECT_EQ(Drummed(text, {{2, 4}, {6, 8}, {10, 30}}), "[4,30)@35 x0 ");
}

TEST(Forms, WhatLastsTooLongIsDropped) {
  const std::string text = "event e(h: Hand, c: Cup) while touching(h, c) lasting 3 ms to 5.5 ms\n";
  EXPECT_EQ(Drummed(text, {{2, 4}, {10, 13}, {20, 25}, {30, 36}, {90, 100}}),
            "[10,13)@13 x0 [20,25)@25 x0 ");
  // That it is none is known before it ends.
  EXPECT_EQ(Drummed("condition tap(h: Hand, c: Cup) while touching(h, c) lasting 3 ms to 5.5 ms\n"
                    "event e(h: Hand, c: Cup) while touching(h, c) and not tap(h, c) lasting 8 ms "
                    "to 8 ms",
                    {{2, 5}, {10, 18}, {20, 30}}),
            "[10,18)@18 x0 ");
}

// "From A to t later" is not over before t is, and what comes later than t is not in time.
TEST(Forms, ADeadlineBetweenTwoTicksIsTheLaterOne) {
  const std::string missed =
      "event missed(h: Hand, c: Cup) from touching(h, c) begins without touching(h, c) ends within "
      "24.6 ms lasting 24.6 ms";
  for (const Tick touch_until : {25, 90}) {
    const std::vector<Event> events = WatchTouch(missed, {0, 10, 25, 40}, touch_until);
    ASSERT_EQ(events.size(), 1u) << touch_until;
    EXPECT_EQ(events[0].interval, (Interval{0, 25}));
  }
  EXPECT_EQ(WatchTouch(missed, {0, 10, 24, 40}, 24).size(), 0u);
}

// The gap at 20 is too long at 40, but only at 90 is it known whether anything is true there.
TEST(Forms, WhatIsDecidedLateIsAskedForWhereItEnded) {
  const std::vector<Event> events = WatchTouch(
      "condition high(c: Cup) while height(c) > 35 mm lasting 50 ms\n"
      "event held(h: Hand, c: Cup) while touching(h, c) or high(c) bridging 4 ms requires "
      "height(c) < 20.5 mm",
      {0, 10, 20, 21, 22, 23, 40, 50, 60, 70, 80, 90}, 20);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].interval, (Interval{0, 20}));
}

/// Where an approach begins of whom the heights and speeds are given, until the hand touches it in
/// the last frame. The hand itself moves along.
Tick ApproachBegin(const std::string& form, Tick step, const std::vector<double>& heights_m,
                   const std::vector<double>& speeds_m_per_s) {
  Scene scene;
  Monitor monitor(
      testing::CompileText("grammar t\nevent e(h: Hand, c: Cup) until touching(h, c) begins since "
                           "not touching(h, c)\napproaching height(c) receding at most 25.5 mm" +
                           form + " at most 100 s back"),
      scene.entity_table);
  std::vector<Event> events;
  for (std::size_t i = 0; i < heights_m.size(); ++i) {
    scene.looks[Scene::kCup].p_WB_m.z() = scene.looks[Scene::kHand].p_WB_m.z() = heights_m[i];
    scene.looks[Scene::kCup].v_WB_m_per_s.x() = speeds_m_per_s[i % speeds_m_per_s.size()];
    scene.collision_sphere.p_W_m.z() = heights_m[i];
    if (i + 1 == heights_m.size()) scene.touches = {{.a = Scene::kHand, .b = Scene::kCup}};
    monitor.Advance(scene.At(step * static_cast<Tick>(i)), events);
  }
  monitor.Finish(step * static_cast<Tick>(heights_m.size()), events);
  EXPECT_EQ(monitor.error(), "");
  return events.size() == 1 ? events[0].interval.begin : -1;
}

// Nobody is ever slow: it is no matter whether it is asked.
TEST(Forms, ASpeedThatIsNeverSlowMovesNoTurningPoint) {
  std::vector<double> heights_m;
  for (int i = 0; i <= 72; ++i)
    heights_m.push_back(i < 40 ? 0.1 + 0.005 * i : std::min(0.3, 0.3 - 0.01 * (i - 42)));
  for (const char* form :
       {"", " over 50 ms", ", with speed(c) slower than 1 cm/s at most 100 ms",
        " over 50 ms, with speed(c) slower than 1 cm/s at most 100 ms",
        " over 50 ms, with speed(c) slower than 1 cm/s at most 100 ms, onset 1 mm/s"})
    EXPECT_EQ(ApproachBegin(form, 10, heights_m, {1}), 420) << form;
}

// It stands at the turning point, then trembles on the way: the stand is no approach, whatever
// pauses may last, and the trembling one.
TEST(Forms, AfterAStandAtTheTurningPointItBeginsWithTheMovement) {
  const std::vector<double> heights_m = {0, 0.1, 0.1, 0.1, 0.099, 0.098, 0.099, 0.098};
  for (const char* most : {"150 ms", "1 s"})
    EXPECT_EQ(ApproachBegin(std::string(", with speed(c) slower than 1 cm/s at most ") + most, 100,
                            heights_m, {0, 0, 0, 0, 0, 0.05, 0.05, 0.05}),
              400)
        << most;
}

// Frames farther apart than the window: none shows that the hand stays.
TEST(Forms, AFrameAloneInItsWindowIsNoPause) {
  for (const Tick step : {100, 240, 251, 300}) {
    std::vector<double> heights_m;
    for (int i = 12; i >= 0; --i) heights_m.push_back(0.0004 * static_cast<double>(step * i));
    EXPECT_EQ(ApproachBegin(", with surface_speed(h) slower than 1 cm/s or within 2.5 mm over 500 "
                            "ms at most 500 ms",
                            step, heights_m, {0}),
              0)
        << step;
  }
}

// At the first begin nobody needs to ask for the tray, so nothing of it would wake the rule later.
TEST(Forms, WhatWasNotAskedForBeforeBeginsTheNextOne) {
  Scene scene;
  Monitor monitor(
      testing::CompileText("grammar t\nevent e(h: Hand, c: Cup, t: Movable)\n"
                           "from touching(h, c) begins or touching(h, t) begins\n"
                           "to touching(h, c) ends during height(c) >= height(c)@begin or drop"),
      scene.entity_table);
  const Touch cup{.a = Scene::kHand, .b = Scene::kCup};
  const Touch tray{.a = Scene::kHand, .b = Scene::kTray};
  const std::vector<std::vector<Touch>> touches = {{cup}, {cup}, {cup}, {cup, tray}, {tray}};
  std::vector<Event> events;
  for (Tick tick = 0; tick < 5; ++tick) {
    scene.looks[Scene::kCup].p_WB_m.z() = tick < 2 ? 1 : 0;  // dropped at 2
    scene.touches = touches[tick];
    monitor.Advance(scene.At(tick), events);
  }
  monitor.Finish(5, events);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].interval, (Interval{3, 4}));
}

TEST(Forms, AttributesAreTakenAtTheBeginUnlessTheySayOtherwise) {
  const std::vector<Event> events = WatchTouch(
      "event held(h: Hand, c: Cup) while touching(h, c)\n"
      "with force = force(h, c) with low = height(c) with high = height(c)@end with lift = rise(c) "
      "* 2",
      {10, 20, 30}, 30);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_DOUBLE_EQ(events[0].attributes[0], 3);
  EXPECT_DOUBLE_EQ(events[0].attributes[1], 0.01);
  EXPECT_DOUBLE_EQ(events[0].attributes[2], 0.03);
  EXPECT_DOUBLE_EQ(events[0].attributes[3], 0.04);
}

TEST(Forms, DefinitionsStandForTheirBodies) {
  const std::string above = "define above(a, level: m) = height(a) > level\n";
  const std::string twice = "define well_above(b: Cup, level: m) = above(b, 2 * level)\n";
  const std::vector<Event> events = WatchTouch(
      above + twice + "event high(c: Cup) while well_above(c, 1 cm)", {0, 10, 20, 30, 40}, 0);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].interval, (Interval{30, 100}));
}

TEST(Forms, SensorSetsHaveNamesAndNumbers) {
  const auto count = [](const std::string& set) {
    return WatchTouch("event e(h: Hand, c: Cup) while sensor_set(h, " + set + ", c)", {0, 10}, 90)
        .size();
  };
  EXPECT_EQ(count("fingers"), 1u);
  EXPECT_EQ(count("\"palm\""), 1u);
  EXPECT_EQ(count("thumb"), 0u);
  EXPECT_EQ(count("1"), 1u);
  EXPECT_EQ(count("2"), 0u);
  EXPECT_EQ(count("nose"), 0u);
}

}  // namespace
}  // namespace prehend::grammar
