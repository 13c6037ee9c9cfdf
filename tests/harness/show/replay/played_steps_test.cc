// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "harness/episode/run/load_run.h"
#include "harness/show/replay/replay_data.h"

namespace prehend::show {
namespace {

TEST(PlayedSteps, AreWhenTheyWerePlayed) {
  const auto loaded = episode::LoadRun(
      {.scenario_file = PREHEND_SOURCE_DIR "/scenarios/pick_and_place/milk_carton_wrap.yaml"},
      PREHEND_SOURCE_DIR);
  ASSERT_TRUE(loaded) << grammar::Format(loaded.error());
  const episode::RunResult run =
      episode::RunScenario(loaded->scenario, loaded->program, {.record = true});
  const std::vector<PlayedStep> steps = PlayedSteps(loaded->scenario, run);
  ASSERT_GE(steps.size(), 5u);
  EXPECT_EQ(steps.front().what, "reach milk");
  EXPECT_EQ(steps.front().who, "right_hand");
  EXPECT_LT(steps.front().begin, 10) << "at once";
  EXPECT_TRUE(steps[1].what.starts_with("close to")) << steps[1].what;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    EXPECT_EQ(steps[i].begin, steps[i - 1].end) << "one after another";
    EXPECT_LT(steps[i].begin, steps[i].end);
  }
  // Fingers close around the thing before it is held.
  const auto& events = run.timeline.events;
  const auto held = std::ranges::find(events, std::string("grasping"), &grammar::NamedEvent::event);
  ASSERT_NE(held, events.end());
  EXPECT_LT(steps[1].begin, held->interval.begin);
  EXPECT_TRUE(PlayedSteps(loaded->scenario, {}).empty());
}

}  // namespace
}  // namespace prehend::show
