// SPDX-License-Identifier: Apache-2.0
#include "harness/truth/timeline/match_events.h"

#include <gtest/gtest.h>

namespace prehend::truth {
namespace {

using grammar::Interval;
using grammar::NamedEvent;
using grammar::Timeline;

NamedEvent Sliding(const std::string& object, Interval interval) {
  return {
      .event = "sliding", .roles = {{"hand", "hand"}, {"object", object}}, .interval = interval};
}

TEST(Agreement, OfATimelineWithItselfIsPerfect) {
  const Timeline timeline{
      .events = {Sliding("cup", {10, 20}), Sliding("cup", {30, 40}), Sliding("mug", {30, 40})}};
  const Agreement agreement = Agree(timeline, timeline, 0);
  EXPECT_EQ(agreement.matched(), 3);
  EXPECT_TRUE(agreement.Within(0));
  EXPECT_EQ(DescribeDisagreement(agreement, 0), "");
}

TEST(Agreement, PairsTheClosestFirstAndEachOnce) {
  const Timeline truth{.events = {Sliding("cup", {0, 100})}};
  const Timeline found{.events = {Sliding("cup", {0, 40}), Sliding("cup", {5, 100})}};
  const Agreement agreement = Agree(truth, found, 0);
  ASSERT_EQ(agreement.matched(), 1);
  EXPECT_EQ(agreement.labels[0].matches[0].begin_offset(), 5);
  EXPECT_EQ(agreement.labels[0].matches[0].end_offset(), 0);
  EXPECT_EQ(agreement.missing(), 0);
  EXPECT_EQ(agreement.extra(), 1);
}

TEST(Agreement, ShortEventsMatchWithinTheCollarWithoutOverlap) {
  const Timeline truth{.events = {Sliding("cup", {10, 12})}},
      found{.events = {Sliding("cup", {14, 16})}};
  EXPECT_EQ(Agree(truth, found, 4).matched(), 1);
  EXPECT_EQ(Agree(truth, found, 3).matched(), 0);
}

TEST(Agreement, OtherRolesAreOtherEventsButAttributesAreNotCompared) {
  NamedEvent pinch = Sliding("cup", {10, 20});
  pinch.roles.push_back({"style", "pinch"});
  const Timeline truth{.events = {Sliding("cup", {10, 20})}};
  EXPECT_EQ(Agree(truth, {.events = {pinch}}, 0).matched(), 1);
  const Agreement other = Agree(truth, {.events = {Sliding("mug", {10, 20})}}, 0);
  EXPECT_EQ(other.missing(), 1);
  EXPECT_EQ(other.extra(), 1);
}

TEST(Agreement, IsDescribedLineByLine) {
  const Timeline truth{.events = {Sliding("cup", {0, 120}), Sliding("milk", {0, 12})}};
  const Timeline found{.events = {Sliding("cup", {12, 118}), Sliding("mug", {6, 12})}};
  const Agreement agreement = Agree(truth, found, 0);
  EXPECT_EQ(agreement.largest_offset(), 12);
  EXPECT_FALSE(agreement.Within(12)) << "something is missing";
  EXPECT_EQ(DescribeDisagreement(agreement, 11),
            "off      sliding(hand, cup)   true 0.0000..0.2500 s  found 0.0250..0.2458 s"
            "  begin +25.0 ms, end -4.2 ms\n"
            "missing  sliding(hand, milk)  true 0.0000..0.0250 s\n"
            "extra    sliding(hand, mug)   found 0.0125..0.0250 s\n");
  EXPECT_EQ(DescribeDisagreement(agreement, 12).find("off"), std::string::npos);
}

}  // namespace
}  // namespace prehend::truth
