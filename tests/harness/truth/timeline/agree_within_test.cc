// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "harness/truth/timeline/match_events.h"

namespace prehend::truth {
namespace {

using grammar::Interval;
using grammar::Timeline;

Timeline Slides(const std::vector<Interval>& intervals) {
  Timeline timeline{.ticks_per_second = 480, .events = {}};
  for (const Interval& interval : intervals)
    timeline.events.push_back({.event = "sliding", .roles = {{"hand", "h"}}, .interval = interval});
  return timeline;
}

constexpr grammar::Tick kCollar = 4;

TEST(AgreeWithin, ABoundaryBetweenEarliestAndLatestHasNoOffset) {
  const std::vector<Timeline> possible = {Slides({{100, 300}}), Slides({{80, 300}}),
                                          Slides({{100, 340}})};
  for (const Interval found : {Interval{80, 300}, Interval{90, 320}, Interval{100, 340}}) {
    const Agreement agreement = AgreeWithin(possible, Slides({found}), kCollar);
    EXPECT_TRUE(agreement.Within(0)) << found.begin << ".." << found.end;
    EXPECT_EQ(agreement.matched(), 1);
  }
}

TEST(AgreeWithin, OutsideItHasTheDistanceToTheNearerEnd) {
  const std::vector<Timeline> possible = {Slides({{100, 300}}), Slides({{80, 300}})};
  const Agreement agreement = AgreeWithin(possible, Slides({{70, 310}}), kCollar);
  ASSERT_EQ(agreement.matched(), 1);
  EXPECT_EQ(agreement.labels[0].matches[0].begin_offset(), -10);
  EXPECT_EQ(agreement.labels[0].matches[0].end_offset(), 10);
}

TEST(AgreeWithin, AnEventIsExtraOnlyIfNoneHasIt) {
  const std::vector<Timeline> possible = {Slides({}), Slides({{100, 200}})};
  EXPECT_EQ(AgreeWithin(possible, Slides({{100, 200}}), kCollar).extra(), 0);
  EXPECT_EQ(AgreeWithin(possible, Slides({{400, 500}}), kCollar).extra(), 1);
}

TEST(AgreeWithin, AnEventIsMissingOnlyIfAllHaveIt) {
  EXPECT_EQ(
      AgreeWithin(std::vector{Slides({{100, 200}}), Slides({})}, Slides({}), kCollar).missing(), 0);
  const Agreement agreement =
      AgreeWithin(std::vector{Slides({{100, 200}}), Slides({{120, 190}})}, Slides({}), kCollar);
  ASSERT_EQ(agreement.missing(), 1);
  EXPECT_EQ(agreement.labels[0].missing[0].interval, (Interval{100, 200}));
}

TEST(AgreeWithin, WhatMayLieBetweenTwoFramesIsNotMissed) {
  EXPECT_EQ(AgreeWithin(std::vector{Slides({{100, 104}})}, Slides({}), kCollar).missing(), 0);
  EXPECT_EQ(AgreeWithin(std::vector{Slides({{100, 105}})}, Slides({}), kCollar).missing(), 1);
}

}  // namespace
}  // namespace prehend::truth
