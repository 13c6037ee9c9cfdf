// SPDX-License-Identifier: Apache-2.0
// Twelve questions about shipped scenarios, six of them "why not", and one per way in which a run
// comes to nothing.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "grammar/monitor.h"
#include "grammar/name_events.h"
#include "tests/harness/explain/explain_stage.h"

namespace prehend::harness::explain::testing {
namespace {

using Mark = Reason::Mark;

constexpr const char* kSlide = "slide/carton_slides_then_is_transported";
constexpr const char* kRetreat = "reach/reach_begins_at_the_return_after_a_retreat";
constexpr const char* kBeside = "grasp/closing_beside_the_carton_is_no_grasp";
constexpr const char* kCandidates = "reach/two_candidates_one_grasped";
constexpr const char* kSlidesIn = "slide/transport_lands_by_sliding_in";

/// The reason is there, so marked; its reading, if it has one, is on the right side of its limit.
void ExpectReason(const Reasons& reasons, const std::string& clause, Mark mark,
                  std::optional<bool> above = {}) {
  const Reason* reason = Find(reasons, clause);
  ASSERT_NE(reason, nullptr) << clause;
  EXPECT_EQ(reason->mark, mark) << clause << ": " << reason->how;
  ASSERT_EQ(reason->reading.has_value(), above.has_value()) << clause;
  if (above) {
    EXPECT_EQ(reason->reading->value >= reason->reading->limit, *above) << reason->how;
  }
}

// Why.

TEST(Explain, AReachBeginsWhereTheApproachTurned) {
  const WhyEvent why = Why(Played(kRetreat), "reaching right_hand milk");
  ASSERT_EQ(why.began.size(), 1);
  EXPECT_EQ(why.began.front().what, "the approach turns here: gap(right_hand, milk)");
  EXPECT_NE(why.began.front().how.find("it may recede by at most 25 mm"), std::string::npos)
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
  const WhyEvent why = Why(Played(kSlide), "grasping@3s");
  ExpectReason(why.began, "trigger(right_hand) < grip_on", Mark::kHeld, true);
  ExpectReason(why.began, "sensor_sets(right_hand, milk) >= grip_sides", Mark::kTurned, true);
  ExpectReason(why.ended, "sensor_sets(right_hand, milk) >= grip_sides", Mark::kTurned, false);
  const Reason* waited = Find(why.waited.front().because, "tight(right_hand, milk)");
  ASSERT_NE(waited, nullptr);
  EXPECT_EQ(waited->how, "a gap of up to 60 ms would have been bridged");
}

TEST(Explain, ACompositionBeginsAndEndsWithItsParts) {
  const WhyEvent why = Why(Played(kSlide), "pick_and_place");
  ASSERT_EQ(why.began.size(), 3);
  EXPECT_EQ(why.began.front().what, "part reaching(right_hand, milk)");
  EXPECT_EQ(why.began.back().what, "part putting_down(right_hand, milk)");
  ExpectReason(why.ended, "touching(milk, table)", Mark::kTurned);
  EXPECT_NE(Find(why.waited, "grasping(right_hand, milk)"), nullptr)
      << "it could not be known before the grasp was over";
}

// Why not.

TEST(ExplainMissing, NoSlideWhereTheCartonMovedTooLittle) {
  const WhyMissing why =
      WhyNot(Played(kSlide, {"slide_distance=30cm"}), "sliding right_hand milk @2.0s");
  const Reason* failed = Find(why.reasons, "to displacement_along(milk, table) >= slide_distance");
  ASSERT_NE(failed, nullptr);
  EXPECT_EQ(failed->mark, Mark::kFailed);
  EXPECT_NEAR(failed->reading->value, 0.2, 0.01);  // the script moves it by 0.2 m
  EXPECT_EQ(failed->reading->limit, 0.3);
  EXPECT_TRUE(why.because.starts_with("to displacement_along(milk, table) >= slide_distance: is 2"))
      << why.because;
  EXPECT_NE(Find(why.reasons, "sliding_along(right_hand, milk, table)"), nullptr);
}

TEST(ExplainMissing, NoGraspWhereTooFewSensorSetsTouched) {
  const WhyMissing why = WhyNot(Played(kBeside), "grasping right_hand milk");
  ExpectReason(why.reasons, "sensor_sets(right_hand, milk) >= grip_sides", Mark::kFailed, false);
  EXPECT_TRUE(
      why.because.starts_with("sensor_sets(right_hand, milk) >= grip_sides: is 0, 2 below 2, at "))
      << why.because;
}

TEST(ExplainMissing, NoReachForACartonThatIsNotTouched) {
  const WhyMissing why = WhyNot(Played(kCandidates), "reaching right_hand juice");
  EXPECT_EQ(why.because, "touching(juice, right_hand): never held so far");
  const Reason* gap = Find(why.reasons, "gap(right_hand, juice)");
  ASSERT_NE(gap, nullptr);
  EXPECT_TRUE(gap->how.starts_with("was smallest at ")) << gap->how;
}

TEST(ExplainMissing, NoPutDownWhereTheCartonSlidesIn) {
  const WhyMissing why = WhyNot(Played(kSlidesIn), "putting_down right_hand milk");
  ExpectReason(why.reasons, "outside low_at_last(right_hand, milk)", Mark::kFailed);
  ExpectReason(why.reasons, "height(position(milk)) - height(position(milk)@end) < put_drop",
               Mark::kHeld, false);
}

TEST(ExplainMissing, NoWholeWithoutAllItsParts) {
  const WhyMissing why = WhyNot(Played(kSlidesIn), "pick_and_place right_hand milk");
  ExpectReason(why.reasons, "first_hold(right_hand, milk)", Mark::kNote);
  ExpectReason(why.reasons, "putting_down(right_hand, milk)", Mark::kFailed);
  EXPECT_TRUE(why.because.starts_with("outside low_at_last(right_hand, milk): it held "))
      << why.because;
}

TEST(ExplainMissing, NoTransportBeforeTheGrasp) {
  const WhyMissing why = WhyNot(Played(kSlide), "transporting right_hand milk @1s");
  ExpectReason(why.reasons, "grasping(right_hand, milk)", Mark::kFailed);
  ExpectReason(why.reasons, "sensor_sets(right_hand, milk) >= grip_sides", Mark::kFailed, false);
  ASSERT_EQ(why.nearest.size(), 1);
  EXPECT_GT(why.nearest.front().interval.begin, *why.expected_at);
}

// Every way in which a run comes to nothing, on frames written by hand.

TEST(ExplainMissing, TooShort) {
  Stage stage("event near(cup: Cup) while height(cup) < 1 m and speed(cup) < 1 m/s lasting 1 s");
  stage.Show(10);
  const WhyMissing why = WhyNot(stage.Finish(), "near cup");
  EXPECT_EQ(why.because, "lasting 1 s: it lasted only 100 ms");
}

TEST(ExplainMissing, TooLate) {
  Stage stage(
      "event answered(h: Hand, c: Cup) from touching(h, c) begins to touching(h, c) ends within 50 "
      "ms");
  stage.Show(3);
  stage.Touch(true);
  stage.Show(10);
  stage.Touch(false);
  stage.Show(3);
  EXPECT_EQ(
      WhyNot(stage.Finish(), "answered").because,
      "to touching(hand, cup) ends: it did not come within 50 ms, but 50 ms later, at 0.1300 s");
}

TEST(ExplainMissing, WhatMustNotComeCame) {
  Stage stage(
      "event left(h: Hand, c: Cup) from touching(h, c) ends without touching(h, c) begins within "
      "500 ms");
  stage.Touch(true);
  stage.Show(3);
  stage.Touch(false);
  stage.Show(10);
  stage.Touch(true);
  stage.Show(60);
  EXPECT_EQ(WhyNot(stage.Finish(), "left@80ms").because,
            "without touching(hand, cup) begins: it came after 100 ms, at 0.1300 s");
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

TEST(ExplainMissing, TheEpisodeEndedBeforeAnAbsenceWasDecided) {
  Stage stage(
      "event left(h: Hand, c: Cup) from touching(h, c) ends without touching(h, c) begins within "
      "500 ms");
  stage.Touch(true);
  stage.Show(3);
  stage.Touch(false);
  stage.Show(6);
  EXPECT_EQ(
      WhyNot(stage.Finish(), "left").because,
      "without touching(hand, cup) begins: it is decided only 500 ms later, the episode ended "
      "before");
}

struct Choice {
  const char* rule;
  const char* because;
};

// The hand touches the cup, which is 0.2 m high and does not move.
TEST(ExplainMissing, AChoiceThatIsFulfilledIsNotBlamed) {
  const Choice choices[] = {
      {"while (touching(h, c) or speed(c) > 1 m/s) and height(c) > 1 m",
       "height(c) > 1 m: is 200 mm"},
      {"while touching(h, c) requires (displacement(c) > 50 cm or rise(c) < 2 cm) and height(c) > "
       "1 m",
       "requires height(c) > 1 m: is 200 mm"},
      {"while touching(h, c) requires not (rise(c) < 2 cm and displacement(c) > 50 cm) and "
       "height(c) > 1 m",
       "requires height(c) > 1 m: is 200 mm"},
      {"from touching(h, c) begins to rise(c) > 1 m begins during (speed(c) > 1 m/s or height(c) < "
       "1 m) and touching(h, c) or drop",
       "to rise(c) > 1 m: is 0 mm"},
      {"until touching(h, c) ends since (speed(c) > 1 m/s or touching(h, c)) and height(c) > 1 m "
       "at most 1 s back",
       "since height(c) > 1 m: is 200 mm"}};
  for (const Choice& choice : choices) {
    Stage stage(std::string("event e(h: Hand, c: Cup) ") + choice.rule);
    stage.CupUpAt(0.2);
    stage.Show(2);
    stage.Touch(true);
    stage.Show(3);
    stage.Touch(false);
    stage.Show(2);
    const WhyMissing why = WhyNot(stage.Finish(), "e");
    std::string because = choice.because;
    because.replace(because.find("(c)") + 1, 1, "cup");
    EXPECT_TRUE(why.because.starts_with(because)) << choice.rule << "\n" << why.because;
    for (const char* other : {"speed(cup) > 1 m/s", "displacement(cup) > 0.5 m"}) {
      for (const char* word : {"", "requires ", "during ", "since "}) {
        const Reason* reason = Find(why.reasons, word + std::string(other));
        EXPECT_TRUE(reason == nullptr || reason->mark == Mark::kHeld) << choice.rule;
      }
    }
  }
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

TEST(ExplainMissing, Dropped) {
  Stage stage(
      "event pushed(h: Hand, c: Cup) from touching(h, c) begins to displacement(c) > 10 cm begins "
      "during touching(h, c) or drop");
  stage.Show(2);
  stage.Touch(true);
  stage.Show(4);
  stage.CupAt(0.05);
  stage.Show(4);
  stage.Touch(false);
  stage.Show(4);
  const WhyMissing why = WhyNot(stage.Finish(), "pushed");
  EXPECT_EQ(why.because, "to displacement(cup) > 0.1 m: is 50 mm, 50 mm below 100 mm, at 0.0600 s");
  EXPECT_EQ(Find(why.reasons, "during touching(cup, hand)")->how, "ended at 0.1000 s");
}

TEST(ExplainMissing, OfAComposedEndEachBeginIsTold) {
  for (const char* to : {"displacement(c) > 10 cm begins and trigger(h) < 0.1",
                         "height(c) > 9 m begins or displacement(c) > 10 cm begins"}) {
    Stage stage(std::string("event pushed(h: Hand, c: Cup) from touching(h, c) begins to ") + to +
                " during touching(h, c) or drop");
    stage.Show(2);
    stage.Touch(true);
    stage.Show(4);
    stage.CupAt(0.05);
    stage.Show(4);
    stage.Touch(false);
    stage.Show(4);
    EXPECT_EQ(WhyNot(stage.Finish(), "pushed").because,
              "to displacement(cup) > 0.1 m: is 50 mm, 50 mm below 100 mm, at 0.0600 s");
  }
}

TEST(ExplainMissing, Unfinished) {
  Stage stage(
      "event pushed(h: Hand, c: Cup) from touching(h, c) begins to displacement(c) > 10 cm begins "
      "during touching(h, c) or drop");
  stage.Show(2);
  stage.Touch(true);
  stage.Show(4);
  EXPECT_EQ(WhyNot(stage.Finish(), "pushed").because,
            "to displacement(cup) > 0.1 m begins: the episode ended before");
}

TEST(ExplainMissing, Unconfirmed) {
  Stage stage(
      "condition held(h: Hand, c: Cup) while trigger(h) > 0.5 and touching(h, c)\n"
      "condition met(h: Hand, c: Cup) while touching(h, c)\n"
      "event toward(h: Hand, c: Cup) until met(h, c) begins since not met(h, c) at most 1 s back\n"
      "  confirmed by held(h, c) within met(h, c)");
  stage.Show(5);
  stage.Touch(true);
  stage.scene.hand.trigger = 0.4;
  stage.Show(5);
  stage.Touch(false);
  stage.Show(5);
  const WhyMissing why = WhyNot(stage.Finish(), "toward");
  ExpectReason(why.reasons, "confirmed by held(hand, cup)", Mark::kFailed);
  const Reason* trigger = Find(why.reasons, "trigger(hand) > 0.5");
  ASSERT_NE(trigger, nullptr);
  EXPECT_EQ(trigger->how, "is 0.4, 0.1 below 0.5");
}

TEST(ExplainMissing, NothingBefore) {
  Stage stage(
      "event toward(h: Hand, c: Cup) until touching(h, c) begins since speed(c) > 1 m/s at most 1 "
      "s "
      "back");
  stage.Show(5);
  stage.Touch(true);
  stage.Show(5);
  const WhyMissing why = WhyNot(stage.Finish(), "toward");
  EXPECT_EQ(why.because, "since speed(cup) > 1 m/s: is 0 mm/s, 1 m/s below 1 m/s, at 0.0400 s");
}

// The first touch is the episode's first frame, and nothing can be before that.
TEST(ExplainMissing, NothingBeforeIsToldOfTheEndThatCameClosest) {
  Stage stage(
      "event toward(h: Hand, c: Cup) until touching(h, c) begins since height(c) > 1 m at most 1 s "
      "back");
  stage.Touch(true);
  stage.Show(2);
  for (const double z_m : {0.2, 0.6, 0.4}) {
    stage.Touch(false);
    stage.CupUpAt(z_m);
    stage.Show(5);
    stage.Touch(true);
    stage.Show(5);
  }
  grammar::ReplayMonitor& past = stage.Finish();
  EXPECT_EQ(WhyNot(past, "toward").because,
            "since height(cup) > 1 m: is 600 mm, 400 mm below 1 m, at 0.1600 s");
}

// A thrown cup: while nothing holds it, the monitor does not look for an end of `placed`.
TEST(ExplainMissing, AnEndThatTheMonitorNeedNotWatchIsACandidate) {
  for (const char* asked : {"placed", "placed@0.15s", "placed@0.2s"}) {
    Stage stage(
        "condition low(c: Cup) while height(c) < 20 cm\n"
        "event placed(h: Hand, c: Cup) until low(c) begins since touching(h, c) at most 1 s back");
    stage.Show(2);
    stage.CupUpAt(0.5);
    stage.Touch(true);
    stage.Show(10);
    stage.Touch(false);
    stage.Show(10);
    stage.CupUpAt(0.1);
    stage.Show(100);
    const WhyMissing why = WhyNot(stage.Finish(), asked);
    EXPECT_EQ(why.because, "since touching(cup, hand): had ended at 0.1200 s") << asked;
    EXPECT_EQ(why.reasons.front().how, "nothing before its end at 0.2200 s") << asked;
  }
}

// 120 ms is too far for what looks back 100 ms.
TEST(ExplainMissing, AnEndThatDoesNotReachBackIsNoReason) {
  Stage stage(
      "event toward(h: Hand, c: Cup) until touching(h, c) begins since speed(c) > 1 m/s at most "
      "100 ms back");
  stage.Show(100);
  stage.Touch(true);
  stage.Show(2);
  grammar::ReplayMonitor& past = stage.Finish();
  EXPECT_EQ(
      WhyNot(past, "toward@0.3s").because,
      "toward(hand, cup): the next end is at 1.0000 s, and the rule reaches at most 100 ms back");
  EXPECT_EQ(WhyNot(past, "toward@0.95s").because,
            "since speed(cup) > 1 m/s: is 0 mm/s, 1 m/s below 1 m/s, at 0.9900 s");
}

// There and back: how far it is at the end is not how close it came.
TEST(ExplainMissing, OfTwoRequirementsTheOneThatCameCloserIsNamed) {
  Stage stage(
      "condition far(h: Hand, c: Cup) from touching(h, c) begins to displacement(c) >= 10 cm "
      "begins "
      "during touching(h, c) or drop\n"
      "event moved(h: Hand, c: Cup) while touching(h, c) requires displacement(c) >= 10 cm or "
      "far(h, c)");
  stage.Touch(true);
  for (const double x_m : {0.0, 0.05, 0.08, 0.03, 0.01}) {
    stage.CupAt(x_m);
    stage.Show(2);
  }
  stage.Touch(false);
  stage.Show(2);
  EXPECT_EQ(WhyNot(stage.Finish(), "moved").because,
            "to displacement(cup) >= 0.1 m: is 80 mm, 20 mm below 100 mm, at 0.0400 s");
}

// The moment that is asked for is meant within 0.25 s, however many rules stand between.
TEST(ExplainMissing, TheWindowAroundAMomentDoesNotGrowFromRuleToRule) {
  Stage stage(
      "condition a(c: Cup) while height(c) > 1 m\ncondition b(c: Cup) while a(c)\n"
      "event e(c: Cup) while b(c)");
  for (int i = 0; i < 100; ++i) {
    stage.CupUpAt(i * 0.009);
    stage.Show();
  }
  EXPECT_EQ(WhyNot(stage.Finish(), "e@0.5s").because,
            "height(cup) > 1 m: is 675 mm, 325 mm below 1 m, at 0.7500 s");
}

TEST(Explain, AClauseOfBothThresholdsIsToldOnce) {
  Stage stage("event e(h: Hand, c: Cup) while touching(h, c) until not touching(h, c)");
  stage.Show(3);
  stage.Touch(true);
  stage.Show(3);
  EXPECT_EQ(Why(stage.Finish(), "e").began.size(), 1);
}

TEST(ExplainMissing, AConditionThatAlmostHeldNamesItsBestMoment) {
  Stage stage("event far(c: Cup, t: Movable) while distance(position(c), position(t)) > 20 cm");
  for (const double x : {0.0, 0.05, 0.12, 0.07, 0.01}) {
    stage.CupAt(x);
    stage.Show();
  }
  EXPECT_EQ(WhyNot(stage.Finish(), "far cup tray").because,
            "distance(position(cup), position(tray)) > 0.2 m: is 120 mm, 80 mm below 200 mm, at "
            "0.0200 s");
}

// An explanation looks at the same episode as the monitor.

TEST(Explain, RememberingChangesNothing) {
  const std::string root = PREHEND_SOURCE_DIR;
  for (const std::string grammar : {"", "original_2020"}) {
    const Result<EpisodeSource> source =
        OpenScenario(root + "/scenarios/" + kSlide + ".yaml", grammar, {}, root);
    ASSERT_TRUE(source);
    grammar::Monitor monitor(source->program, source->entity_table);
    grammar::ReplayMonitor past(source->program, source->entity_table);
    std::vector<grammar::Event> events;
    const auto played = source->play([&](const grammar::Frame& frame) {
      monitor.Advance(frame, events);
      past.Advance(frame);
    });
    monitor.Finish(played.end, events);
    past.Finish(played.end);
    const auto named = [&](const std::vector<grammar::Event>& all) {
      return grammar::NameEvents(*source->program, source->entity_table, all).events;
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
}  // namespace prehend::harness::explain::testing
