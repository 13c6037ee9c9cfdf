// SPDX-License-Identifier: Apache-2.0
#include "harness/show/figures/figures.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/harness/show/figures/played.h"

namespace prehend::show {
namespace {

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

TEST(Figures, ThingsHaveRowsByNameAndThoseThatStayAreLast) {
  const auto& [loaded, run] = Of("bimanual/tray_with_three_things_is_carried");
  const auto names_of = [](const Chart& chart) {
    std::vector<std::string> names;
    for (const Row& row : chart.rows)
      if (row.name.ends_with(" on")) names.push_back(row.name);
    return names;
  };
  const Chart chart = PhasesChart(loaded.scenario, run, WholeOf(run));
  const std::vector<std::string> names = names_of(chart);
  ASSERT_EQ(names.size(), 4u);
  EXPECT_EQ(names[0], "tray on") << "the others stay on it";
  const auto tray = std::ranges::find(chart.rows, "tray on", &Row::name);
  ASSERT_EQ(tray->bars.size(), 2u);
  EXPECT_EQ(tray->bars[0].text, "table");
  EXPECT_EQ(tray->bars[0].tip, "supported_by(tray, table)");
  Window in_the_air = WholeOf(run);
  in_the_air.from_s = 2, in_the_air.to_s = 4;
  const std::vector<std::string> then = names_of(PhasesChart(loaded.scenario, run, in_the_air));
  EXPECT_EQ(std::ranges::count(then, "tray on"), 0) << "no bar of it is in the window";
  EXPECT_EQ(then.size(), 3u);
}

TEST(Figures, SeriesShowWhatMovesAndWhoPresses) {
  const auto& [loaded, run] = Of("bimanual/two_hands_carry_a_plate_of_a_kilogram");
  const Chart chart = SeriesChart(loaded.scenario, run, WholeOf(run));
  ASSERT_EQ(chart.panels.size(), 3u) << "nothing tilts";
  EXPECT_EQ(chart.panels[0].curves.size(), 2u) << "plate and cake, not the stand";
  ASSERT_EQ(chart.panels[2].curves.size(), 2u);
  const Curve& force = chart.panels[2].curves[0];
  EXPECT_EQ(force.points.size(), run.recording.size());
  EXPECT_LT(force.points.front().second, 1e-9);
  EXPECT_GT(force.points.back().second, 10) << "a kilogram between two hands, newtons";
}

TEST(Figures, ScenesOfASeriesShowTheTwist) {
  const auto& [loaded, run] = Of("bimanual/plate_of_a_kilogram_twists_out_of_one_hand");
  const auto moments = SeriesMoments(SeriesChart(loaded.scenario, run, WholeOf(run)), 3);
  const auto twist = std::ranges::find_if(moments, [](const KeyMoment& moment) {
    return moment.caption.starts_with("tilt of plate: ");
  });
  ASSERT_NE(twist, moments.end());
  EXPECT_GT(twist->time_s, 1.7) << "it is level until then";
  EXPECT_LT(twist->time_s, 2.2) << "it lies on the table then";
  const auto& [level, its_run] = Of("bimanual/two_hands_carry_a_plate_of_a_kilogram");
  const Chart chart = SeriesChart(level.scenario, its_run, WholeOf(its_run));
  const auto scenes = SeriesMoments(chart, 3);
  for (const KeyMoment& moment : scenes)
    EXPECT_EQ(moment.caption.find("tilt"), std::string::npos) << "two hands keep it level";
  double most_m = 0;
  for (const Curve& curve : chart.panels[0].curves)
    for (const auto& [time_s, height_m] : curve.points) most_m = std::max(most_m, height_m);
  EXPECT_TRUE(std::ranges::any_of(scenes, [&](const KeyMoment& moment) {
    return moment.caption.ends_with(fmt::format(": {:.3g} m", most_m));
  })) << most_m;
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

TEST(Figures, AWindowLeavesOtherHandsAndThingsOut) {
  const auto& [loaded, run] = Of("bimanual/two_hands_carry_a_plate_of_a_kilogram");
  Window window = WholeOf(run);
  const std::size_t all = PhasesChart(loaded.scenario, run, window).rows.size();
  window.hand = "left_hand";
  const Chart chart = PhasesChart(loaded.scenario, run, window);
  EXPECT_LT(chart.rows.size(), all);
  EXPECT_TRUE(std::ranges::none_of(
      chart.rows, [](const Row& row) { return row.name.starts_with("right_hand"); }));
  window = WholeOf(run);
  window.entity = "nothing";
  EXPECT_TRUE(PhasesChart(loaded.scenario, run, window).rows.empty());
}

}  // namespace
}  // namespace prehend::show
