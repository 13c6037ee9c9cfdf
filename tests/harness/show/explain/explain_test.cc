// SPDX-License-Identifier: Apache-2.0
// Why events of shipped scenarios are as they are, and what can be asked.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "grammar/monitor.h"
#include "grammar/name_events.h"
#include "tests/harness/show/explain/explain_stage.h"

namespace prehend::show::testing {
namespace {

using Mark = Reason::Mark;

constexpr const char* kRetreat = "reach/reach_begins_at_the_return_after_a_retreat";

TEST(Explain, AReachBeginsWhereTheApproachTurned) {
  const WhyEvent why = Why(Played(kRetreat), "reaching right_hand milk");
  ASSERT_EQ(why.began.size(), 1);
  EXPECT_EQ(why.began.front().what, "the approach turns here: gap(right_hand, milk)");
  EXPECT_NE(why.began.front().how.find("it may recede by at most 25 mm"), std::string::npos)
      << why.began.front().how;
  EXPECT_NE(why.began.front().how.find(" s it receded by "), std::string::npos)
      << why.began.front().how;
  ExpectReason(why.ended, "touching(milk, right_hand)", Mark::kTurned);
  EXPECT_NE(Find(why.counted, "confirmed by grasping(right_hand, milk)"), nullptr);
  EXPECT_NE(Find(why.waited, "grasping(right_hand, milk)"), nullptr);
}

TEST(Explain, ASlideBeginsAndEndsWithTheMotionAlongTheTable) {
  const WhyEvent why = Why(Played(kSlide), "sliding@2s");
  ExpectReason(why.began, "grasping(right_hand, milk)", Mark::kHeld);
  ExpectReason(why.began, "moving_along(right_hand, milk, table)", Mark::kTurned);
  ExpectReason(why.began, "speed_along(milk, table) >= slide_speed", Mark::kTurned, true);
  ExpectReason(why.began, "drift_along(milk, table, slide_window) >= slide_speed", Mark::kHeld,
               true);
  ExpectReason(why.ended, "speed_along(milk, table) >= slide_speed", Mark::kTurned, false);
  EXPECT_EQ(Find(why.began, "speed_along(milk, table) >= slide_speed")->tick, why.interval.begin);
  EXPECT_EQ(Find(why.ended, "speed_along(milk, table) >= slide_speed")->tick, why.interval.end);
  // moving_along bridges gaps of 150 ms, two rules down.
  EXPECT_EQ(why.decided - why.interval.end, 72);
  EXPECT_EQ(Find(why.waited, "moving_along(right_hand, milk, table)")->because.front().how,
            "a gap of up to 150 ms would have been bridged");
}

TEST(Explain, APickUpBeginsWhenTheTableIsLost) {
  const WhyEvent why = Why(Played(kSlide), "picking_up(right_hand, milk)");
  ExpectReason(why.began, "supported_by(milk, table)", Mark::kTurned);
  ExpectReason(why.began, "touching(milk, table)", Mark::kTurned);
  ExpectReason(why.ended,
               "in_cylinder(position(milk), position(milk)@begin, lift_radius, lift_height)",
               Mark::kTurned, true);
  ExpectReason(why.counted, "requires rise(milk) >= lift_rise", Mark::kHeld, true);
}

TEST(Explain, ATransportEndsWhereThePutDownBegins) {
  const WhyEvent why = Why(Played(kSlide), "transporting");
  ExpectReason(why.began, "picking_up(right_hand, milk)", Mark::kTurned);
  ExpectReason(why.ended, "putting_down(right_hand, milk)", Mark::kTurned);
  ExpectReason(why.ended, "in_cylinder(position(milk), position(milk)@end, put_radius, put_height)",
               Mark::kTurned, false);
  EXPECT_NE(Find(why.waited, "putting_down(right_hand, milk)"), nullptr);
}

TEST(Explain, AGraspEndsWithTheSensorSets) {
  const WhyEvent why = Why(Played("weight/six_kilograms_stay_on_the_table"), "grasping");
  ExpectReason(why.began, "trigger(right_hand) < grip_on", Mark::kHeld, true);
  ExpectReason(why.began, "sensor_sets(right_hand, milk) >= grip_sides", Mark::kTurned, true);
  ExpectReason(why.ended, "sensor_sets(right_hand, milk) >= grip_sides", Mark::kTurned, false);
  const Reason* waited = Find(why.waited.back().because, "tight(right_hand, milk)");
  ASSERT_NE(waited, nullptr);
  EXPECT_EQ(waited->how, "a gap of up to 60 ms would have been bridged");
}

TEST(Explain, ACompositionBeginsAndEndsWithItsParts) {
  const WhyEvent why = Why(Played(kSlide), "pick_and_place");
  ASSERT_EQ(why.began.size(), 3);
  EXPECT_EQ(why.began.front().what, "part reaching(right_hand, milk)");
  EXPECT_EQ(why.began.back().what, "part putting_down(right_hand, milk)");
  ExpectReason(why.ended, "touching(milk, table)", Mark::kTurned);
  EXPECT_NE(Find(why.waited, "first_hold(right_hand, milk)"), nullptr)
      << "it could not be known before the grasp was over";
}

// 55 ms are over five milliseconds before the frame in which the touch begins again.
TEST(Explain, WhatCameTooLateIsNoReason) {
  Stage stage(
      "event left(h: Hand, c: Cup) from touching(h, c) ends without touching(h, c) begins within "
      "55 ms");
  stage.Touch(true);
  stage.Show(3);
  stage.Touch(false);
  stage.Show(6);
  stage.Touch(true);
  stage.Show(3);
  const WhyEvent why = Why(stage.Finish(), "left");
  ASSERT_EQ(why.ended.size(), 1);
  EXPECT_EQ(why.ended.front().what, "nothing came within 55 ms");
  EXPECT_EQ(why.interval.end, 85);
}

TEST(Explain, OfARequiredChoiceWhatFulfilsItIsTold) {
  Stage stage(
      "event e(h: Hand, c: Cup) while touching(h, c) requires displacement(c) > 50 cm or rise(c) < "
      "2 cm");
  stage.Show(2);
  stage.Touch(true);
  stage.Show(3);
  stage.Touch(false);
  stage.Show(2);
  const WhyEvent why = Why(stage.Finish(), "e");
  ASSERT_EQ(why.counted.size(), 1);
  EXPECT_EQ(why.counted.front().what, "requires rise(cup) < 0.02 m");
}

TEST(Explain, AClauseOfBothThresholdsIsToldOnce) {
  Stage stage("event e(h: Hand, c: Cup) while touching(h, c) until not touching(h, c)");
  stage.Show(3);
  stage.Touch(true);
  stage.Show(3);
  EXPECT_EQ(Why(stage.Finish(), "e").began.size(), 1);
}

// An explanation looks at the same episode as the monitor.

TEST(Explain, RememberingChangesNothing) {
  const std::string root = PREHEND_SOURCE_DIR;
  for (const std::string grammar : {"", "original_2020", "pick_and_place_from_motion"}) {
    Result<episode::Episode> episode = episode::OpenEpisode(
        {.file = root + "/scenarios/" + kSlide + ".yaml"}, {grammar, {}}, root);
    ASSERT_TRUE(episode);
    grammar::Monitor monitor(episode->program(), episode->entities());
    grammar::ReplayMonitor past(episode->program(), episode->entities());
    std::vector<grammar::Event> events;
    const auto played = episode->EachFrame([&](const grammar::Frame& frame) {
      monitor.Advance(frame, events);
      past.Advance(frame);
    });
    monitor.Finish(played.tick, events);
    past.Finish(played.tick);
    const auto named = [&](const std::vector<grammar::Event>& all) {
      return grammar::NameEvents(*episode->program(), episode->entities(), all).events;
    };
    const auto expected = named(events), remembered = named(past.events());
    ASSERT_EQ(remembered.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(remembered[i].Label(), expected[i].Label());
      EXPECT_EQ(remembered[i].interval, expected[i].interval);
      EXPECT_EQ(remembered[i].decided, expected[i].decided);
    }
    // And every event has a row with both reasons, whatever the grammar.
    std::size_t explained = 0;
    for (const WhyEvent& why : ExplainAll(past)) {
      EXPECT_FALSE(why.began.empty()) << why.event;
      EXPECT_FALSE(why.ended.empty()) << why.event;
      ++explained;
    }
    EXPECT_EQ(explained, expected.size());
  }
}

// Two conditions of the event, each of which waits for the same third one.
TEST(Explain, WhatIsWaitedForTwiceIsSaidOnce) {
  Stage stage(
      "condition apart(c: Cup, t: Movable)\n"
      "  while distance(position(c), position(t)) > 20 cm bridging 20 ms\n"
      "condition one(c: Cup, t: Movable) while apart(c, t)\n"
      "condition two(c: Cup, t: Movable) while apart(c, t)\n"
      "event moved(c: Cup, t: Movable) while one(c, t) and two(c, t)");
  stage.Show(2);
  stage.CupAt(0.3);
  stage.Show(3);
  stage.CupAt(0.1);
  stage.Show(5);
  const WhyEvent why = Why(stage.Finish(), "moved");
  ASSERT_EQ(why.waited.size(), 2U);
  EXPECT_EQ(why.waited[0].what, "one(cup, tray)");
  ASSERT_EQ(why.waited[0].because.size(), 1U);
  EXPECT_EQ(why.waited[0].because[0].what, "apart(cup, tray)");
  ASSERT_EQ(why.waited[0].because[0].because.size(), 1U);
  EXPECT_EQ(why.waited[0].because[0].because[0].how,
            "a gap of up to 20 ms would have been bridged");
  EXPECT_EQ(why.waited[1].what, "two(cup, tray)");
  EXPECT_TRUE(why.waited[1].because.empty());
}

TEST(Explain, TheTextIsAlignedAndTheJsonHasTheNumbers) {
  Stage stage("event moved(c: Cup, t: Movable) while distance(position(c), position(t)) > 20 cm");
  stage.Show(2);
  stage.CupAt(0.3);
  stage.Show(3);
  stage.CupAt(0.1);
  stage.Show(2);
  const WhyEvent why = Why(stage.Finish(), "moved");
  EXPECT_EQ(Text(why, 1000),
            "moved(cup, tray)  0.0200..0.0500 s  (test:2)\n"
            "  began at 0.0200 s\n"
            "  > distance(position(cup), position(tray)) > 0.2 m  rose to 300 mm, above 200 mm\n"
            "  ended at 0.0500 s\n"
            "  > distance(position(cup), position(tray)) > 0.2 m  fell to 100 mm, below 200 mm\n"
            "  decided at 0.0500 s, at its end\n");
  const nlohmann::ordered_json json = ToJson(why, 1000);
  EXPECT_EQ(json["began"][0]["value"], 0.3);
  EXPECT_EQ(json["began"][0]["limit"], 0.2);
  EXPECT_EQ(json["began"][0]["unit"], "m");
  EXPECT_EQ(json["ended"][0]["time_s"], 0.05);
}

struct BadAsk {
  const char* text;
  const char* complaint;
};

TEST(Ask, BadOnesNamePlaceAndRemedy) {
  const BadAsk asks[] = {
      {"",
       "--event:1:1: error: found no event, wanted one of the grammar's\n  hint: for example: "
       "moved@1.2s\n"},
      {"mved@1s",
       "--event:1:1: error: found 'mved', wanted an event or condition of grammar 'test'\n  "
       "mved@1s\n  ^\n"
       "  hint: did you mean 'moved'?\n"},
      {"moving@1s",
       "--event:1:1: error: found 'moving', wanted an event or condition of grammar 'test'\n  "
       "moving@1s\n  ^\n"
       "  hint: did you mean 'moved'?\n"},
      {"moved cpu",
       "--event:1:7: error: found 'cpu', wanted an entity of the episode\n  moved cpu\n        ^\n"
       "  hint: did you mean 'cup'?\n"},
      {"moved milk",
       "--event:1:7: error: found 'milk', wanted an entity of the episode\n  moved milk\n        "
       "^\n"
       "  hint: there are: hand, cup, tray\n"},
      {"moved hand",
       "--event:1:7: error: found 'hand', a Hand; the role 'c' of 'moved' wants a Cup\n  moved "
       "hand\n        ^\n"},
      {"moved c=cup d=tray",
       "--event:1:13: error: found 'd', wanted a role of 'moved'\n  moved c=cup d=tray\n           "
       "   ^\n"
       "  hint: there are: c, t\n"},
      {"moved cup tray hand",
       "--event:1:16: error: found 'hand', but 'moved' has 2 roles\n  moved cup tray hand\n        "
       "         ^\n"},
      {"moved cup c=cup",
       "--event:1:13: error: the role 'c' is named twice\n  moved cup c=cup\n              ^\n"},
      {"moved @ soon",
       "--event:1:9: error: found 'soon', wanted a time from the episode's begin\n  moved @ soon\n "
       "         ^\n"
       "  hint: for example: @1.24s, @1240 ms\n"},
      {"moved@-1s",
       "--event:1:7: error: found '-1s', wanted a time from the episode's begin\n  moved@-1s\n     "
       "   ^\n"
       "  hint: for example: @1.24s, @1240 ms\n"},
      {"moved@5min",
       "--event:1:7: error: found '5min', wanted a time from the episode's begin\n  moved@5min\n   "
       "     ^\n"
       "  hint: for example: @1.24s, @1240 ms\n"},
  };
  Stage stage("event moved(c: Cup, t: Movable) while distance(position(c), position(t)) > 20 cm");
  stage.Show();
  grammar::ReplayMonitor& past = stage.Finish();
  for (const BadAsk& bad : asks) {
    const Result<Ask> ask = ParseAsk("--event", bad.text, past.program(), past.entity_table());
    EXPECT_FALSE(ask);
    EXPECT_EQ(Format(ErrorsOf(ask)), bad.complaint);
  }
}

TEST(Ask, RolesAndTimesInAnyFashion) {
  Stage stage("event moved(c: Cup, t: Movable) while distance(position(c), position(t)) > 20 cm");
  stage.Show();
  grammar::ReplayMonitor& past = stage.Finish();
  for (const char* text : {"moved cup tray@1.5s", "moved(cup, tray) @ 1500ms",
                           "moved t=tray c=cup@1.5", "moved cup,tray @1500 ms"}) {
    const Ask ask = Asked(past, text);
    EXPECT_EQ(ask.entities[0], 1) << text;
    EXPECT_EQ(ask.entities[1], 2) << text;
    EXPECT_EQ(ask.time_s, 1.5) << text;
  }
  EXPECT_EQ(Asked(past, "moved any tray").entities[0], grammar::kNone);
  EXPECT_FALSE(Asked(past, "moved").time_s);
}

}  // namespace
}  // namespace prehend::show::testing
