// SPDX-License-Identifier: Apache-2.0
// "Why not", asked of shipped scenarios, and one question per way in which a run comes to nothing.
#include <gtest/gtest.h>

#include "grammar/base/frame.h"
#include "tests/harness/show/explain/explain_stage.h"

namespace prehend::show::testing {
namespace {

using Mark = Reason::Mark;

constexpr const char* kBeside = "grasp/closing_beside_the_carton_is_no_grasp";
constexpr const char* kCandidates = "reach/two_candidates_one_grasped";
constexpr const char* kSlidesIn = "slide/transport_lands_by_sliding_in";

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

// Either order of the roles would do; a hand is no Thing, but that is not why they were not near.
TEST(ExplainMissing, WhatCanNotBeIsNoReasonWhereAnotherFailed) {
  Stage stage(
      "condition near(t: Thing, h: Hand) while distance(t, h) <= 5 cm\n"
      "symmetric event met(a: Entity, b: Entity) while near(a, b) or near(b, a)");
  stage.CupAt(0.3);
  stage.Show(10);
  const WhyMissing why = WhyNot(stage.Finish(), "met hand cup");
  EXPECT_EQ(why.because,
            "distance(cup, hand) <= 0.05 m: is 300 mm, 250 mm above 50 mm, at 0.0000 s");
  const Reason* impossible = Find(why.reasons, "near(hand, cup)");
  ASSERT_NE(impossible, nullptr);
  EXPECT_TRUE(impossible->impossible);
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
TEST(ExplainMissing, AChoiceThatIsFulfilledIsNoReason) {
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

// It falls, rises by 20 cm, and is touched then.
TEST(ExplainMissing, AnApproachThatReceded) {
  Stage stage(
      "event toward(h: Hand, c: Cup) until touching(h, c) begins since not touching(h, c)\n"
      "  approaching height(c) receding at most 2 cm at most 1 s back");
  for (const double z_m : {0.5, 0.1, 0.3}) {
    stage.CupUpAt(z_m);
    stage.Show(10);
  }
  stage.Touch(true);
  stage.Show(5);
  const WhyMissing why = WhyNot(stage.Finish(), "toward@0.05s");
  EXPECT_EQ(why.because,
            "the approach turns here: height(cup): is 300 mm; at 0.1900 s it was 100 mm, until "
            "0.2000 s it receded by 200 mm, and it may recede by at most 20 mm");
}

TEST(ExplainMissing, WhatHeldInsteadIsNamed) {
  Stage stage(
      "condition near(h: Hand, c: Cup) while touching(h, c)\n"
      "condition busy(c: Cup) while height(c) > 9 m or near(any, c)\n"
      "event idle(c: Cup) while not busy(c)");
  stage.Touch(true);
  stage.Show(10);
  const WhyMissing why = WhyNot(stage.Finish(), "idle cup @0.05s");
  EXPECT_EQ(why.because, "busy(cup): held from the first frame on, by near(hand, cup)");
  const Reason* held = Find(why.reasons, "near(hand, cup)");
  ASSERT_NE(held, nullptr);
  EXPECT_EQ(held->mark, Mark::kHeld);
  EXPECT_EQ(held->how, "held 0.0000..0.1000 s");
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

// The cup leaves the region around its begin, which ends the interval, by 1 cm; it is 17 cm too
// low.
TEST(ExplainMissing, OfARequiredConjunctionTheClauseThatMissedByMostIsNamed) {
  for (const char* required : {"near(c, position(c)@begin) and rise(c) > 20 cm or gone(c)",
                               "gone(c) or rise(c) > 20 cm and near(c, position(c)@begin)",
                               "not (not near(c, position(c)@begin) or rise(c) <= 20 cm)"}) {
    Stage stage(
        "define near(c: Cup, place: position) = in_cylinder(position(c), place, 9 cm, 50 cm)\n"
        "condition gone(c: Cup) while height(c) > 9 m\n"
        "event moved(c: Cup) from height(c) > 52 cm begins to not near(c, position(c)@begin) "
        "begins\n"
        "  requires " +
        std::string(required));
    stage.Show(2);
    stage.CupUpAt(0.53);
    for (const double x_m : {0.01, 0.05, 0.11, 0.11}) {
      stage.CupAt(x_m);
      stage.Show();
      stage.CupUpAt(0.6);
    }
    const WhyMissing why = WhyNot(stage.Finish(), "moved");
    EXPECT_TRUE(why.because.starts_with("requires rise(cup) ")) << why.because;
    const Reason* near = Find(why.reasons,
                              "requires in_cylinder(position(cup), position(cup)@begin, 0.09 m, "
                              "0.5 m)");
    ASSERT_NE(near, nullptr);
    EXPECT_EQ(near->mark, Mark::kFailed);
  }
}

TEST(ExplainMissing, ABeginOfSeveralMomentsIsNamed) {
  Stage stage(
      "condition high(c: Cup) while height(c) > 1 m\n"
      "event e(h: Hand, c: Cup) from (touching(h, c) ends or high(c) begins) and not touching(h, "
      "c)\n  to height(c) > 2 m begins");
  stage.Touch(true);
  stage.Show(3);
  EXPECT_EQ(WhyNot(stage.Finish(), "e").because,
            "from (touching(hand, cup) ends or high(cup) begins) and not touching(hand, cup): did "
            "not become true by 0.0200 s");
}

// Of what is not tracked neither a condition nor its opposite holds.
TEST(ExplainMissing, WhatIsNotTrackedIsNotAsItHasToBe) {
  for (const char* condition :
       {"not (distance(h, c) < 10 cm)", "not in_sphere(position(c), position(h), 10 cm)",
        "not gazed(h, c)"}) {
    Stage stage(std::string("event far(h: Hand, c: Cup) while trigger(h) >= 0 and ") + condition);
    stage.scene.looks[stage.scene.kCup] = grammar::NotTracked();
    stage.scene.looks[stage.scene.kHand] = grammar::NotTracked();
    stage.Show(5);
    const WhyMissing why = WhyNot(stage.Finish(), "far");
    EXPECT_TRUE(why.because.ends_with(": is unknown: what it measures is not tracked"))
        << why.because;
  }
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

}  // namespace
}  // namespace prehend::show::testing
