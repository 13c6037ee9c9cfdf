// SPDX-License-Identifier: Apache-2.0
// A timeline that is as it should be, and each invariant broken once.
#include <gtest/gtest.h>

#include "harness/suite/judge/judges.h"

namespace prehend::suite {
namespace {

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
          .two_frames = 4,
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
    Break{"an_event_does_not_overlap_itself", "supported_by(cup, table) overlaps itself", 299,
          [](Timeline& t) { t.events[10].interval.begin = 299; }},
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
  EXPECT_EQ(Invariants().size(), 3u);  // a new one belongs into the table above, too
}

TEST(Invariants, ALawIsReportedWithItsTextAndPlace) {
  grammar::Law law{.name = "cups_touch",
                   .file = "cups.grammar",
                   .place = {3, 5},
                   .roles = {{"a", "Cup"}, {"b", "Cup"}},
                   .says = "meeting(a, b) lies inside contact(a, b)"};
  EXPECT_EQ(
      Text(grammar::LawViolation{&law, {48, 96}, "meeting(x, y) lies inside no contact(x, y)"},
           480),
      "cups_touch at 0.1000..0.2000 s: meeting(x, y) lies inside no contact(x, y)\n"
      "  cups.grammar:3: law cups_touch(a: Cup, b: Cup) meeting(a, b) lies inside contact(a, "
      "b)");
}

}  // namespace
}  // namespace prehend::suite
