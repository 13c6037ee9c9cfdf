// SPDX-License-Identifier: Apache-2.0
// A timeline that is as it should be, and each invariant broken once.
#include "harness/check/invariants.h"

#include <gtest/gtest.h>

#include "harness/timeline/interval_set.h"

namespace prehend::harness {
namespace {

using grammar::Interval;
using grammar::NamedEvent;
using grammar::Tick;
using grammar::Timeline;

NamedEvent Event(const std::string& event, std::vector<grammar::Role> roles, Tick begin, Tick end) {
  return {.event = event, .roles = std::move(roles), .interval = {begin, end}, .decided = end + 4};
}

NamedEvent OfHand(const std::string& event, Tick begin, Tick end) {
  return Event(event, {{"hand", "hand"}, {"object", "cup"}}, begin, end);
}

/// Reach, slide a little, lift, carry and put down again.
Timeline PickAndPlace() {
  return {.ticks_per_second = 480,
          .events = {
              Event("contact", {{"a", "cup"}, {"b", "table"}}, 0, 300),
              Event("supported_by", {{"object", "cup"}, {"support", "table"}}, 0, 300),
              OfHand("reaching", 50, 150),
              OfHand("fixation", 150, 200),
              OfHand("grasping", 200, 700),
              OfHand("sliding", 220, 300),
              OfHand("picking_up", 300, 400),
              OfHand("transporting", 400, 500),
              OfHand("putting_down", 500, 600),
              Event("contact", {{"a", "cup"}, {"b", "table"}}, 600, 1000),
              Event("supported_by", {{"object", "cup"}, {"support", "table"}}, 600, 1000),
          }};
}

EpisodeFacts Facts() {
  return {.end = 1000,
          .movable = {"cup"},
          .ticks_per_frame = 2,
          .latency = {{"grasping", {.seconds = 0.1}},
                      {"fixation", {.seconds = 0, .until_end_of = {"contact"}}}}};
}

NamedEvent& Find(Timeline& timeline, const std::string& event) {
  return *std::find_if(timeline.events.begin(), timeline.events.end(),
                       [&](const NamedEvent& candidate) { return candidate.event == event; });
}

TEST(Invariants, HoldOfAnOrdinaryTimeline) {
  for (const Violation& violation : CheckInvariants(PickAndPlace(), Facts()))
    ADD_FAILURE() << Text(violation, 480);
}

struct Break {
  const char* invariant;
  const char* what;
  Tick tick;
  void (*change)(Timeline& timeline);
};

class BrokenInvariant : public testing::TestWithParam<Break> {};

TEST_P(BrokenInvariant, IsReported) {
  Timeline timeline = PickAndPlace();
  GetParam().change(timeline);
  const Violations violations = CheckInvariants(timeline, Facts());
  const bool found =
      std::any_of(violations.begin(), violations.end(), [](const Violation& violation) {
        return violation.invariant == GetParam().invariant && violation.what == GetParam().what &&
               violation.tick == GetParam().tick;
      });
  std::string all;
  for (const Violation& violation : violations) all += Text(violation, 480) + "\n";
  EXPECT_TRUE(found) << all;
}

const Break kBreaks[] = {
    Break{"events_lie_inside_the_episode", "reaching(hand, cup) does not end after it begins", 150,
          [](Timeline& t) {
            Find(t, "reaching").interval = {150, 150};
          }},
    Break{"events_lie_inside_the_episode", "contact(cup, table) reaches out of the episode", 600,
          [](Timeline& t) { t.events[9].interval.end = 1001; }},
    Break{"phases_lie_inside_a_grasp", "putting_down(hand, cup) does not lie inside a grasp", 500,
          [](Timeline& t) { Find(t, "grasping").interval.end = 590; }},
    Break{"phases_lie_inside_a_grasp", "sliding(other_hand, cup) does not lie inside a grasp", 220,
          [](Timeline& t) { Find(t, "sliding").roles[0].value = "other_hand"; }},
    Break{"phases_do_not_overlap", "transporting(hand, cup) overlaps picking_up", 390,
          [](Timeline& t) { Find(t, "transporting").interval.begin = 390; }},
    Break{"phases_cover_the_grasp",
          "cup is held unsupported by hand for 0.8333..0.8542 s and belongs to no phase", 400,
          [](Timeline& t) { Find(t, "transporting").interval.begin = 410; }},
    Break{"phases_fit_the_support", "sliding(hand, cup) goes on without support", 300,
          [](Timeline& t) { Find(t, "sliding").interval.end = 310; }},
    Break{"phases_fit_the_support", "picking_up(hand, cup) goes on while supported", 290,
          [](Timeline& t) { Find(t, "picking_up").interval.begin = 290; }},
    Break{"reaches_meet_what_follows", "reaching(hand, cup) meets neither a fixation nor a grasp",
          149, [](Timeline& t) { Find(t, "reaching").interval.end = 149; }},
    Break{"reaches_meet_what_follows", "fixation(hand, cup) does not meet a grasp", 199,
          [](Timeline& t) { Find(t, "fixation").interval.end = 199; }},
    Break{"supports_lie_inside_contacts",
          "supported_by(cup, table) does not lie inside a contact of the two", 0,
          [](Timeline& t) { Find(t, "contact").interval.begin = 1; }},
    Break{"decisions_come_in_time",
          "grasping(hand, cup) was decided at 1.5688 s, by its rule it is certain at 1.5667 s", 753,
          [](Timeline& t) { Find(t, "grasping").decided = 753; }},
    Break{"decisions_come_in_time",
          "fixation(hand, cup) was decided at 0.6354 s, by its rule it is certain at 0.6333 s", 305,
          [](Timeline& t) { Find(t, "fixation").decided = 305; }},  // its contact ends at 300
    Break{"decisions_come_in_time", "grasping(hand, cup) was decided before it ended", 699,
          [](Timeline& t) { Find(t, "grasping").decided = 699; }}};

INSTANTIATE_TEST_SUITE_P(Table, BrokenInvariant, testing::ValuesIn(kBreaks));

TEST(Invariants, EachOfTheTableIsBrokenAbove) {
  EXPECT_EQ(Invariants().size(), 8u);  // a new one belongs into the table above, too
}

TEST(Invariants, AHeldFixtureNeedsNoPhase) {
  Timeline timeline = {.ticks_per_second = 480, .events = {OfHand("grasping", 200, 700)}};
  EpisodeFacts facts = Facts();
  EXPECT_EQ(CheckInvariants(timeline, facts).size(), 1u);
  facts.movable.clear();
  EXPECT_TRUE(CheckInvariants(timeline, facts).empty());
}

TEST(IntervalSet, UnionWithoutCovers) {
  const IntervalSet set = Union({{10, 20}, {0, 5}, {20, 30}, {3, 4}, {7, 7}});
  EXPECT_EQ(set, (IntervalSet{{0, 5}, {10, 30}}));
  EXPECT_EQ(Without({2, 40}, set), (IntervalSet{{5, 10}, {30, 40}}));
  EXPECT_EQ(Without({10, 30}, set), IntervalSet{});
  EXPECT_TRUE(Covers(set, {12, 30}));
  EXPECT_FALSE(Covers(set, {4, 11}));
}

}  // namespace
}  // namespace prehend::harness
