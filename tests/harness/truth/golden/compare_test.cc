// SPDX-License-Identifier: Apache-2.0
// Which events are partners, what is said of each, and what a person reads about it.
#include "harness/truth/golden/compare.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace prehend::truth {
namespace {

constexpr grammar::Tick kRate = 1000;  // one tick is a millisecond

grammar::NamedEvent Event(const std::string& event, const std::string& object, grammar::Tick begin,
                          grammar::Tick end, const std::string& style = "") {
  grammar::NamedEvent named{
      .event = event, .roles = {{"hand", "hand"}, {"object", object}}, .interval = {begin, end}};
  if (!style.empty()) named.roles.push_back({"style", style});
  return named;
}

using Events = std::vector<grammar::NamedEvent>;

Comparison CompareEvents(const Events& expected, const Events& actual,
                         std::optional<int> tolerance_ms = {}) {
  Golden golden{.scenario = "s/x", .grammar = "g", .ticks_per_second = kRate};
  for (const auto& event : expected) {
    golden.events.push_back(
        {.event = event, .tolerance_ms = tolerance_ms, .because = "test", .comments = {}});
  }
  return Compare(golden, {.ticks_per_second = kRate, .events = actual}, /*default_tolerance=*/8);
}

/// "matched 0:0 shifted 1:1 missing 2:- extra -:2", events by their begin ticks.
std::string Outline(const Comparison& comparison) {
  std::string text;
  for (const Pairing& pairing : comparison.pairings) {
    const auto begin = [](const auto& event) {
      return event ? std::to_string(event->interval.begin) : "-";
    };
    text += std::string(Name(pairing.agreement)) + " " + begin(pairing.expected) + ":" +
            begin(pairing.actual) + " ";
  }
  return text;
}

struct Case {
  const char* name;
  Events expected, actual;
  const char* outline;
};

class CompareTable : public testing::TestWithParam<Case> {};

TEST_P(CompareTable, PairsAsAPersonWould) {
  EXPECT_EQ(Outline(CompareEvents(GetParam().expected, GetParam().actual)), GetParam().outline);
}

std::string NameOf(const testing::TestParamInfo<Case>& row) { return row.param.name; }

INSTANTIATE_TEST_SUITE_P(
    Table, CompareTable,
    testing::Values(Case{"equal",
                         {Event("grasping", "cup", 100, 200)},
                         {Event("grasping", "cup", 100, 200)},
                         "matched 100:100 "},
                    Case{"within",
                         {Event("grasping", "cup", 100, 200)},
                         {Event("grasping", "cup", 108, 192)},
                         "matched 100:108 "},
                    Case{"late",
                         {Event("grasping", "cup", 100, 200)},
                         {Event("grasping", "cup", 109, 200)},
                         "shifted 100:109 "},
                    Case{"missing", {Event("grasping", "cup", 100, 200)}, {}, "missing 100:- "},
                    Case{"extra", {}, {Event("grasping", "cup", 100, 200)}, "extra -:100 "},
                    Case{"far_apart_is_no_shift",
                         {Event("grasping", "cup", 100, 200)},
                         {Event("grasping", "cup", 600, 700)},
                         "missing 100:- extra -:600 "},
                    Case{"near_without_overlap_is_a_shift",
                         {Event("grasping", "cup", 100, 200)},
                         {Event("grasping", "cup", 210, 310)},
                         "shifted 100:210 "},
                    Case{"as_many_as_possible",  // greedy by closeness would pair 300 with 290 and
                                                 // leave 100 alone
                         {Event("grasping", "cup", 100, 200), Event("grasping", "cup", 300, 400)},
                         {Event("grasping", "cup", 290, 400), Event("grasping", "cup", 420, 500)},
                         "shifted 100:290 shifted 300:420 "},
                    Case{"fragmented",
                         {Event("grasping", "cup", 100, 400)},
                         {Event("grasping", "cup", 100, 140), Event("grasping", "cup", 150, 400)},
                         "fragmented -:100 fragmented 100:150 "},
                    Case{"merged",
                         {Event("grasping", "cup", 100, 140), Event("grasping", "cup", 150, 400)},
                         {Event("grasping", "cup", 100, 400)},
                         "merged 100:- merged 150:100 "},
                    Case{"changed_role",
                         {Event("grasping", "cup", 100, 200)},
                         {Event("grasping", "mug", 104, 210)},
                         "changed 100:104 "},
                    Case{"role_at_another_time",
                         {Event("grasping", "cup", 100, 200)},
                         {Event("grasping", "mug", 180, 400)},
                         "missing 100:- extra -:180 "},
                    Case{"changed_attribute",
                         {Event("grasping", "cup", 100, 200, "wrap")},
                         {Event("grasping", "cup", 100, 200, "pinch")},
                         "changed 100:100 "},
                    Case{"another_event",
                         {Event("sliding", "cup", 100, 200)},
                         {Event("transporting", "cup", 100, 200)},
                         "relabelled 100:100 "},
                    Case{"another_event_at_another_time",
                         {Event("sliding", "cup", 100, 200)},
                         {Event("transporting", "cup", 180, 300)},
                         "missing 100:- extra -:180 "},
                    Case{"another_event_of_another_thing",
                         {Event("sliding", "cup", 100, 200)},
                         {Event("transporting", "mug", 100, 200)},
                         "missing 100:- extra -:100 "}),
    NameOf);

TEST(Compare, ALineMayStateItsOwnTolerance) {
  const Events expected = {Event("grasping", "cup", 100, 200)};
  const Events actual = {Event("grasping", "cup", 120, 200)};
  EXPECT_TRUE(CompareEvents(expected, actual, 20).Agrees());
  EXPECT_FALSE(CompareEvents(expected, actual, 19).Agrees());
}

TEST(Compare, TicksOfAnotherRateAreConverted) {
  Golden golden{.scenario = "s/x", .grammar = "g", .ticks_per_second = 500};
  golden.events.push_back({.event = Event("grasping", "cup", 50, 100),
                           .tolerance_ms = {},
                           .because = {},
                           .comments = {}});
  const Comparison comparison = Compare(
      golden, {.ticks_per_second = kRate, .events = {Event("grasping", "cup", 100, 200)}}, 0);
  EXPECT_TRUE(comparison.Agrees());
}

TEST(Compare, AnEndByTheEpisodeIsNotAnEndOfItsOwn) {
  Events actual = {Event("grasping", "cup", 100, 200)};
  actual[0].open_end = true;
  const Comparison comparison = CompareEvents({Event("grasping", "cup", 100, 200)}, actual);
  ASSERT_EQ(comparison.Count(LineVerdict::kChanged), 1);
  EXPECT_EQ(comparison.pairings[0].changes,
            std::vector<std::string>{"end: of its own -> of the episode"});
}

TEST(Compare, TheMarginIsThatOfTheBoundaryNearestToItsTolerance) {
  const Comparison comparison =
      CompareEvents({Event("grasping", "cup", 100, 200), Event("sliding", "cup", 150, 180)},
                    {Event("grasping", "cup", 101, 200), Event("sliding", "cup", 150, 175)});
  EXPECT_EQ(MarginText(comparison), "margin: 3.0 of 8.0 ms left at end of sliding(hand, cup)");
  const Comparison at_the_limit =
      CompareEvents({Event("grasping", "cup", 100, 200)}, {Event("grasping", "cup", 92, 200)});
  EXPECT_TRUE(at_the_limit.Agrees());
  EXPECT_EQ(MarginText(at_the_limit),
            "passed at the limit: grasping(hand, cup) begins 8.0 ms off (tolerance 8.0 ms)");
  EXPECT_EQ(MarginText(CompareEvents({}, {})), "");
}

TEST(Compare, AToleranceBetweenTwoTicksIsAsItIsWritten) {
  Golden golden{.ticks_per_second = 480};
  golden.events.push_back({.event = Event("grasping", "cup", 100, 200), .tolerance_ms = 12});
  const auto ends_at = [&](grammar::Tick end) {
    return Compare(golden,
                   {.ticks_per_second = 480, .events = {Event("grasping", "cup", 100, end)}}, 4);
  };
  EXPECT_EQ(MarginText(ends_at(205)), "margin: 1.6 of 12.0 ms left at end of grasping(hand, cup)");
  EXPECT_TRUE(ends_at(205).Agrees());   // 10.4 ms
  EXPECT_FALSE(ends_at(206).Agrees());  // 12.5 ms
  EXPECT_NE(DifferenceText(ends_at(206), "").find("end +12.5 ms (tolerance 12.0 ms)"),
            std::string::npos);
}

TEST(Compare, TheTextSaysWhatWhenHowMuchAndHowToSeeIt) {
  const Comparison comparison =
      CompareEvents({Event("grasping", "cup", 100, 200), Event("sliding", "cup", 150, 180)},
                    {Event("grasping", "cup", 150, 198), Event("transporting", "cup", 160, 180)});
  EXPECT_EQ(DifferenceText(comparison, "explain x"),
            "shifted grasping(hand, cup)\n"
            "  expected 0.1000..0.2000 s, recognised 0.1500..0.1980 s\n"
            "  begin +50.0 ms, end -2.0 ms (tolerance 8.0 ms)\n"
            "  why: explain x --event 'grasping hand cup @0.1500s'\n"
            "relabelled sliding(hand, cup)\n"
            "  expected 0.1500..0.1800 s, recognised 0.1600..0.1800 s\n"
            "  begin +10.0 ms, end +0.0 ms (tolerance 8.0 ms)\n"
            "  event: sliding -> transporting\n"
            "  why: explain x --event 'transporting hand cup @0.1600s'\n");
  const Comparison agrees =
      CompareEvents({Event("grasping", "cup", 100, 200)}, {Event("grasping", "cup", 100, 200)});
  EXPECT_EQ(DifferenceText(agrees, "explain x"), "");
  EXPECT_EQ(MarginText(agrees), "margin: all boundaries match exactly");
}

TEST(Compare, PiecesAreToldTogetherAndTheFirstDivergenceFirst) {
  const Comparison comparison =
      CompareEvents({Event("grasping", "cup", 100, 400), Event("sliding", "mug", 500, 600),
                     Event("sliding", "mug", 620, 700)},
                    {Event("grasping", "cup", 100, 140), Event("grasping", "cup", 150, 300),
                     Event("grasping", "cup", 310, 400), Event("sliding", "mug", 500, 700)});
  EXPECT_EQ(DifferenceText(comparison, "explain x", "  facts\n"),
            "fragmented grasping(hand, cup)\n"
            "  expected 0.1000..0.4000 s, recognised 3 pieces: 0.1000..0.1400 s, 0.1500..0.3000 s, "
            "0.3100..0.4000 s\n"
            "  facts\n"
            "  why: explain x --event 'grasping hand cup @0.1000s'\n"
            "merged sliding(hand, mug)\n"
            "  expected 2 pieces: 0.5000..0.6000 s, 0.6200..0.7000 s, recognised 0.5000..0.7000 s\n"
            "  why: explain x --event 'sliding hand mug @0.5000s'\n");
  ASSERT_NE(comparison.FirstDivergence(), nullptr);
  EXPECT_EQ(comparison.FirstDivergence()->DivergenceTick(), 140);
}

TEST(Compare, ProgramsAreToldTheSame) {
  const Comparison comparison =
      CompareEvents({Event("grasping", "cup", 100, 200), Event("holding", "cup", 100, 200),
                     Event("reaching", "cup", 0, 100), Event("sliding", "mug", 300, 400)},
                    {Event("grasping", "cup", 150, 198), Event("holding", "cup", 100, 200),
                     Event("reaching", "cup", 0, 50), Event("reaching", "cup", 60, 100)});
  const auto differences = DifferencesJson(comparison, "explain x");
  ASSERT_EQ(differences.size(), 3u);
  EXPECT_EQ(differences[0]["kind"], "fragmented");
  EXPECT_EQ(differences[0]["pieces"].size(), 2u);
  EXPECT_EQ(differences[0]["pieces"][1]["begin_s"], 0.06);
  EXPECT_EQ(differences[0]["why"], "explain x --event 'reaching hand cup @0.0000s'");
  EXPECT_EQ(DifferencesJson(comparison, "")[0]["why"], "") << "nobody can be asked";
  EXPECT_EQ(differences[1], nlohmann::ordered_json::parse(R"({
    "kind": "shifted", "event": "grasping",
    "expected": {"event": "grasping", "roles": {"hand": "hand", "object": "cup"}, "attributes": {},
                 "begin_tick": 100, "end_tick": 200, "begin_s": 0.1, "end_s": 0.2, "open_end": false},
    "recognised": {"event": "grasping", "roles": {"hand": "hand", "object": "cup"}, "attributes": {},
                   "begin_tick": 150, "end_tick": 198, "begin_s": 0.15, "end_s": 0.198, "open_end": false},
    "begin_ms": 50.0, "end_ms": -2.0, "tolerance_ms": 8.0, "changes": [], "pieces": [],
    "why": "explain x --event 'grasping hand cup @0.1500s'"})"));
  EXPECT_EQ(differences[2]["kind"], "missing");
  EXPECT_TRUE(differences[2]["recognised"].is_null());
  EXPECT_TRUE(differences[2]["begin_ms"].is_null());
  const auto relations = RelationsJson(comparison);
  ASSERT_EQ(relations.size(), 1u) << relations;
  EXPECT_EQ(relations[0]["expected"], "equals");
  EXPECT_EQ(relations[0]["recognised"], comparison.relations[0].actual);
}

TEST(Compare, ALateEndDivergesAtTheEnd) {
  const Comparison comparison =
      CompareEvents({Event("grasping", "cup", 100, 400)}, {Event("grasping", "cup", 104, 450)});
  ASSERT_NE(comparison.FirstDivergence(), nullptr);
  EXPECT_EQ(comparison.FirstDivergence()->DivergenceTick(), 400);
}

TEST(Compare, AMissingEventIsAskedForAsExpected) {
  const Comparison missing = CompareEvents({Event("grasping", "cup", 100, 400, "wrap")}, {});
  EXPECT_EQ(DifferenceText(missing, "explain x"),
            "missing grasping(hand, cup)\n"
            "  expected 0.1000..0.4000 s, recognised nothing\n"
            "  why: explain x --expected 'grasping hand cup @0.1000s'\n");
}

TEST(Compare, ARelationThatClearlyChangedIsTold) {
  const Events expected = {Event("reaching", "cup", 100, 200), Event("grasping", "cup", 200, 400),
                           Event("grasping", "mug", 200, 400)};
  Events actual = expected;
  actual[0].interval.end = 150;
  const Comparison gap = CompareEvents(expected, actual);
  ASSERT_EQ(gap.relations.size(), 1u);
  EXPECT_NE(DifferenceText(gap, "explain x")
                .find("relation reaching(hand, cup) meets grasping(hand, cup): now before\n"),
            std::string::npos);
  actual[0].interval.end = 204;  // overlaps now, but within the tolerance: nothing worth telling
  actual[0].interval.begin = 50;
  const Comparison jitter = CompareEvents(expected, actual);
  EXPECT_EQ(jitter.Count(LineVerdict::kShifted), 1);
  EXPECT_TRUE(jitter.relations.empty());
}

TEST(Compare, ValuesMayDifferALittle) {
  const auto with_force = [](double force_n, const char* unit = "N") {
    grammar::NamedEvent event = Event("grasping", "cup", 100, 200);
    event.values = {{"force", force_n, unit}};
    return Events{event};
  };
  EXPECT_TRUE(CompareEvents(with_force(10), with_force(10.4)).Agrees());
  EXPECT_FALSE(CompareEvents(with_force(10), with_force(10.6)).Agrees());
  EXPECT_TRUE(CompareEvents(with_force(0), with_force(0.0009)).Agrees());
  EXPECT_FALSE(CompareEvents(with_force(10), with_force(10, "kN")).Agrees());
  // The weight of what is fixed.
  EXPECT_TRUE(CompareEvents(with_force(HUGE_VAL), with_force(HUGE_VAL)).Agrees());
  EXPECT_FALSE(CompareEvents(with_force(HUGE_VAL), with_force(10)).Agrees());
  EXPECT_FALSE(CompareEvents(with_force(10), with_force(HUGE_VAL)).Agrees());
  EXPECT_FALSE(CompareEvents(with_force(HUGE_VAL), with_force(-HUGE_VAL)).Agrees());
  const Comparison gone = CompareEvents(with_force(10), {Event("grasping", "cup", 100, 200)});
  ASSERT_EQ(gone.Count(LineVerdict::kChanged), 1);
  EXPECT_EQ(gone.pairings[0].changes, std::vector<std::string>{"force: 10 N -> none"});
  EXPECT_TRUE(CompareEvents({Event("grasping", "cup", 100, 200)}, with_force(10)).Agrees())
      << "a golden that says nothing of a value demands none";
}

}  // namespace
}  // namespace prehend::truth
