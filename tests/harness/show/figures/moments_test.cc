// SPDX-License-Identifier: Apache-2.0
#include "harness/show/figures/moments.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/harness/show/figures/played.h"

namespace prehend::show {
namespace {

using Names = std::vector<std::string>;

TEST(Moments, KeyMomentsAreInOrderAndNoMoreThanAskedFor) {
  const episode::RunResult& run = Of("pick_and_place/milk_carton_wrap").run;
  const auto moments = KeyMoments(run, WholeOf(run), 10);
  ASSERT_EQ(moments.size(), 10u);
  EXPECT_TRUE(std::ranges::is_sorted(moments, {}, &KeyMoment::time_s));
  EXPECT_EQ(moments.front().caption, "reaching begins") << "the begin shows nothing of its own";
  EXPECT_EQ(moments.front().involved, (Names{"right_hand", "milk"}));
  EXPECT_EQ(moments.back().caption, "end");
  EXPECT_EQ(std::ranges::count(moments, "picking_up begins", &KeyMoment::caption), 1);
  EXPECT_EQ(KeyMoments(run, WholeOf(run), 3).size(), 3u);
  const auto part = KeyMoments(run, {.from_s = 1.2, .to_s = 2}, 10);
  EXPECT_EQ(part.front().time_s, 1.2);
  EXPECT_EQ(part.front().caption, "begin");
  EXPECT_LE(part.back().time_s, 2);
}

TEST(Moments, OfAChartAreInsideOfTheEpisodeOrNamed) {
  const auto& [loaded, run] = Of("pick_and_place/milk_carton_wrap");
  const auto events = EventMoments(run, WholeOf(run), 5);
  ASSERT_EQ(events.size(), 5u);
  EXPECT_EQ(std::ranges::count(events, "end", &KeyMoment::caption), 0);
  const auto named = NamedMoments({"reaching.begin", "1.5"}, *loaded.program, run);
  ASSERT_TRUE(named) << named.error();
  EXPECT_EQ((*named)[0].caption, "reaching.begin");
  EXPECT_NEAR((*named)[1].time_s, 1.5, 0.01);
  EXPECT_NE(NamedMoments({"reachin.begin"}, *loaded.program, run).error(), "");
}

TEST(Moments, ALookHasItsDwellAndDistance) {
  const auto& [loaded, run] = Of("gaze/eyes_lead_the_hand");
  const auto looks = Looks(loaded.scenario, run, WholeOf(run));
  ASSERT_FALSE(looks.empty());
  const auto longest = std::ranges::max_element(looks, {}, &Look::Dwell_s);
  EXPECT_EQ(longest->person, "anna");
  EXPECT_EQ(longest->seen, "milk");
  EXPECT_NEAR(longest->Dwell_s(), 1.9, 0.1);
  EXPECT_NEAR(longest->distance_m, 0.58, 0.05);
  for (const Look& look : Looks(loaded.scenario, run, {.from_s = 1, .to_s = 2}))
    EXPECT_TRUE(look.begin_s >= 1 && look.end_s <= 2);
}

TEST(Moments, AGraspHasItsSensors) {
  const auto& [loaded, run] = Of("pick_and_place/milk_carton_wrap");
  const auto held = LongestGrasp(loaded.scenario, run);
  ASSERT_TRUE(held);
  EXPECT_EQ(held->style, "wrap");
  EXPECT_EQ(held->sensor_sets, (Names{"fingers", "thumb"}));
}

}  // namespace
}  // namespace prehend::show
