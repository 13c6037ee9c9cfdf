// SPDX-License-Identifier: Apache-2.0
// The comparison of engines: it agrees on what is shipped, and it can disagree.
#include <gtest/gtest.h>

#include "harness/episode/run/load_run.h"
#include "harness/suite/judge/other_view.h"

namespace prehend::suite {
namespace {

episode::LoadedRun Prepare(const std::string& scenario) {
  const std::string root = PREHEND_SOURCE_DIR;
  auto loaded =
      episode::LoadRun({.scenario_file = root + "/scenarios/" + scenario + ".yaml"}, root);
  EXPECT_TRUE(loaded) << grammar::Format(loaded.error());
  return *loaded;
}

TEST(CrossEngineTest, TheGripperDoesTheSameInBothEngines) {
  const episode::LoadedRun loaded = Prepare("planar/gripper_carries_box");
  episode::RunResult run = episode::RunScenario(loaded.scenario, loaded.program);
  const auto compared = CompareEngines(loaded.scenario, loaded.program, run.timeline);
  ASSERT_TRUE(compared);
  EXPECT_EQ(compared->other, physics::Engine::kBullet);
  EXPECT_NE(compared->run.state_hash, run.state_hash) << "another engine";
  EXPECT_TRUE(compared->comparison.Agrees()) << truth::DifferenceText(compared->comparison, "");

  ASSERT_GE(run.timeline.events.size(), 3u);
  run.timeline.events.pop_back();
  run.timeline.events.front().interval.begin += run.timeline.ticks_per_second / 10;
  const auto differs = CompareEngines(loaded.scenario, loaded.program, run.timeline);
  EXPECT_EQ(differs->comparison.Count(truth::LineVerdict::kExtra), 1);
  EXPECT_EQ(differs->comparison.Count(truth::LineVerdict::kShifted), 1);
}

TEST(CrossEngineTest, ASpatialScenarioHasOneEngine) {
  const episode::LoadedRun loaded = Prepare("pick_and_place/milk_carton_wrap");
  EXPECT_FALSE(CompareEngines(loaded.scenario, loaded.program, {}));
}

}  // namespace
}  // namespace prehend::suite
