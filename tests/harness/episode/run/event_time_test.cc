// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "grammar/program/program.h"
#include "harness/episode/run/run_scenario.h"

namespace prehend::episode {
namespace {

RunResult RunWithReach() {
  RunResult run;
  run.ticks = 960;
  run.timeline.ticks_per_second = 480;
  run.timeline.events.push_back({.event = "reaching", .interval = {100, 200}});
  return run;
}

TEST(EventTime, IsATimeOrABoundary) {
  EXPECT_EQ(ParseEventTime("1.25")->time_s, 1.25);
  EXPECT_EQ(ParseEventTime("reaching.begin")->event, "reaching");
  EXPECT_TRUE(ParseEventTime("reaching.end")->end);
  for (const char* bad : {"", "reaching", ".begin", "reaching.middle", "-1", "nan", "1 s"}) {
    EXPECT_FALSE(ParseEventTime(bad)) << bad;
  }
}

TEST(EventTime, IsFoundInTheEpisode) {
  const RunResult run = RunWithReach();
  EXPECT_EQ(FindEventTime("reaching.begin", run).tick, 100);
  EXPECT_EQ(FindEventTime("reaching.end", run).tick, 200);
  EXPECT_EQ(FindEventTime("1", run).tick, 480);
  EXPECT_EQ(FindEventTime("1", run).missed, "");
}

TEST(EventTime, OneThatIsMissedIsTheEndAndSaysWhy) {
  const RunResult run = RunWithReach();
  EXPECT_EQ(FindEventTime("sliding.end", run).tick, 960);
  EXPECT_EQ(FindEventTime("sliding.end", run).missed, "sliding.end did not happen");
  EXPECT_EQ(FindEventTime("500", run).tick, 960);
  EXPECT_EQ(FindEventTime("500", run).missed, "500 s is after the end");
}

TEST(EventTime, TheGrammarMustHaveTheEvent) {
  grammar::Program program;
  program.name = "probe";
  program.rules.push_back({.name = "reaching", .printed = true});
  program.rules.push_back({.name = "hidden"});
  EXPECT_FALSE(WhyNoEventTime("reaching.begin", program));
  EXPECT_FALSE(WhyNoEventTime("3.5", program));
  EXPECT_EQ(WhyNoEventTime("reching.begin", program)->message,
            "grammar 'probe' has no event 'reching'");
  EXPECT_EQ(WhyNoEventTime("reching.begin", program)->hint, "did you mean 'reaching'?");
  EXPECT_TRUE(WhyNoEventTime("hidden.begin", program));
  EXPECT_EQ(WhyNoEventTime("soon", program)->message, "'soon' is not a time");
}

}  // namespace
}  // namespace prehend::episode
