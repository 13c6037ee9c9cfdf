// SPDX-License-Identifier: Apache-2.0
#include "harness/figures/figures.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace prehend::harness::figures {
namespace {

struct Played {
  LoadedRun loaded;
  RunResult run;
};

const Played& Of(const std::string& scenario) {
  static std::map<std::string, Played> played;
  const auto [found, is_new] = played.try_emplace(scenario);
  if (is_new) {
    const std::string root = PREHEND_SOURCE_DIR;
    Result<LoadedRun> loaded =
        LoadRun({.scenario_file = root + "/scenarios/" + scenario + ".yaml"}, root);
    EXPECT_TRUE(loaded) << scenario;
    found->second.loaded = *loaded;
    found->second.run = RunScenario(loaded->scenario, loaded->program, {.record = true});
  }
  return found->second;
}

TEST(Figures, KeyMomentsAreInOrderAndNoMoreThanAskedFor) {
  const RunResult& run = Of("pick_and_place/milk_carton_wrap").run;
  const auto moments = KeyMoments(run, WholeOf(run), 10);
  ASSERT_EQ(moments.size(), 10u);
  EXPECT_TRUE(std::ranges::is_sorted(moments, {}, &KeyMoment::time_s));
  EXPECT_EQ(moments.front().caption, "begin");
  EXPECT_EQ(moments.back().caption, "end");
  EXPECT_EQ(std::ranges::count(moments, "picking_up begins", &KeyMoment::caption), 1);
  EXPECT_EQ(KeyMoments(run, WholeOf(run), 3).size(), 3u);
  const auto part = KeyMoments(run, {1.2, 2}, 10);
  EXPECT_EQ(part.front().time_s, 1.2);
  EXPECT_LE(part.back().time_s, 2);
}

TEST(Figures, PhasesHaveARowPerHandAndEvent) {
  const auto& [loaded, run] = Of("pick_and_place/milk_carton_wrap");
  const Chart chart = PhasesChart(loaded.scenario, run, WholeOf(run));
  std::vector<std::string> names;
  for (const Row& row : chart.rows) {
    names.push_back(row.name);
    for (std::size_t i = 1; i < row.bars.size(); ++i)
      EXPECT_LE(row.bars[i - 1].end_s, row.bars[i].begin_s + 1e-9) << row.name;
  }
  EXPECT_EQ(names.front(), "right_hand");
  EXPECT_EQ(std::ranges::count(names, "right_hand: grasping"), 1);
  const Chart both = SideBySide(chart, "mine", chart, "yours");
  ASSERT_EQ(both.rows.size(), 2 * chart.rows.size());
  EXPECT_EQ(both.rows[0].name, "right_hand (mine)");
  EXPECT_EQ(both.rows[1].name, "right_hand (yours)");
}

TEST(Figures, SeriesShowWhatMovesAndWhoPresses) {
  const auto& [loaded, run] = Of("bimanual/two_hands_carry_a_plate_of_a_kilogram");
  const Chart chart = SeriesChart(loaded.scenario, run, WholeOf(run));
  ASSERT_EQ(chart.panels.size(), 3u);
  EXPECT_EQ(chart.panels[0].curves.size(), 2u) << "plate and cake, not the stand";
  ASSERT_EQ(chart.panels[2].curves.size(), 2u);
  const Curve& force = chart.panels[2].curves[0];
  EXPECT_EQ(force.points.size(), run.recording.size());
  EXPECT_LT(force.points.front().second, 1e-9);
  EXPECT_GT(force.points.back().second, 10) << "a kilogram between two hands, newtons";
}

TEST(Figures, GazeIsWhatPersonsSee) {
  const auto& [loaded, run] = Of("gaze/eyes_lead_the_hand");
  const auto chart = GazeChart(loaded.scenario, run, WholeOf(run));
  ASSERT_TRUE(chart);
  EXPECT_TRUE(std::ranges::any_of(chart->rows,
                                  [](const Row& row) { return row.name == "anna sees milk"; }));
  const auto& [alone, its_run] = Of("pick_and_place/milk_carton_wrap");
  EXPECT_FALSE(GazeChart(alone.scenario, its_run, WholeOf(its_run)));
}

TEST(Figures, AGraspHasItsSensors) {
  const auto& [loaded, run] = Of("pick_and_place/milk_carton_wrap");
  const auto held = LongestGrasp(loaded.scenario, run);
  ASSERT_TRUE(held);
  EXPECT_EQ(held->style, "wrap");
  EXPECT_EQ(held->sensor_sets, (std::vector<std::string>{"fingers", "thumb"}));
}

}  // namespace
}  // namespace prehend::harness::figures
