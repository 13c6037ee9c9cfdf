// SPDX-License-Identifier: Apache-2.0
#include "harness/run/event_time.h"

#include <gtest/gtest.h>

namespace prehend::harness {
namespace {

RunResult RunWithReach() {
  RunResult run;
  run.ticks = 960;
  run.timeline.ticks_per_second = 480;
  run.timeline.events.push_back({.event = "reaching", .interval = {100, 200}});
  return run;
}

TEST(Moment, IsATimeOrABoundary) {
  EXPECT_EQ(ParseMoment("1.25")->time_s, 1.25);
  EXPECT_EQ(ParseMoment("reaching.begin")->event, "reaching");
  EXPECT_TRUE(ParseMoment("reaching.end")->end);
  for (const char* bad : {"", "reaching", ".begin", "reaching.middle", "-1", "nan", "1 s"}) {
    EXPECT_FALSE(ParseMoment(bad)) << bad;
  }
}

TEST(Moment, IsFoundInTheEpisode) {
  const RunResult run = RunWithReach();
  EXPECT_EQ(FindMoment("reaching.begin", run).tick, 100);
  EXPECT_EQ(FindMoment("reaching.end", run).tick, 200);
  EXPECT_EQ(FindMoment("1", run).tick, 480);
  EXPECT_EQ(FindMoment("1", run).missed, "");
}

TEST(Moment, OneThatIsMissedIsTheEndAndSaysWhy) {
  const RunResult run = RunWithReach();
  EXPECT_EQ(FindMoment("sliding.end", run).tick, 960);
  EXPECT_EQ(FindMoment("sliding.end", run).missed, "sliding.end did not happen");
  EXPECT_EQ(FindMoment("500", run).tick, 960);
  EXPECT_EQ(FindMoment("500", run).missed, "500 s is after the end");
}

TEST(Moment, TheGrammarMustHaveTheEvent) {
  grammar::Program program;
  program.name = "probe";
  program.events.push_back({.name = "reaching", .printed = true});
  program.events.push_back({.name = "hidden"});
  EXPECT_FALSE(WhyNoMoment("reaching.begin", program));
  EXPECT_FALSE(WhyNoMoment("3.5", program));
  EXPECT_EQ(WhyNoMoment("reching.begin", program)->message,
            "grammar 'probe' has no event 'reching'");
  EXPECT_EQ(WhyNoMoment("reching.begin", program)->hint, "did you mean 'reaching'?");
  EXPECT_TRUE(WhyNoMoment("hidden.begin", program));
  EXPECT_EQ(WhyNoMoment("soon", program)->message, "'soon' is no moment");
}

}  // namespace
}  // namespace prehend::harness
