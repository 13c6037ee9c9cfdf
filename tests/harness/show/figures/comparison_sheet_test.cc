// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "harness/show/figures/figures.h"
#include "harness/show/pictures/pictures.h"
#include "tests/harness/show/figures/played.h"

namespace prehend::show {
namespace {

/// A golden like the run, of which `change` has changed something.
template <typename Change>
std::pair<episode::RunResult, truth::Comparison> GoldenLike(const episode::RunResult& run,
                                                            const Change& change) {
  episode::RunResult golden;
  golden.timeline = run.timeline;
  golden.drawings = run.drawings;
  change(golden.timeline.events);
  truth::Golden expected{.ticks_per_second = run.timeline.ticks_per_second};
  for (const grammar::NamedEvent& event : golden.timeline.events)
    expected.events.push_back({.event = event});
  truth::Comparison comparison = truth::Compare(expected, run.timeline, 4);
  return {std::move(golden), std::move(comparison)};
}

grammar::NamedEvent& EventOf(std::vector<grammar::NamedEvent>& events, const std::string& name) {
  return *std::ranges::find(events, name, &grammar::NamedEvent::event);
}

const Row* RowOf(const Chart& chart, const std::string& name) {
  const auto row = std::ranges::find(chart.rows, name, &Row::name);
  return row == chart.rows.end() ? nullptr : &*row;
}

TEST(ComparisonSheet, HatchesWhereTwoSidesDiffer) {
  const auto& [loaded, run] = Of("pick_and_place/milk_carton_wrap");
  const auto [golden, comparison] =
      GoldenLike(run, [](auto& events) { EventOf(events, "transporting").interval.end -= 48; });
  const Side first{"golden", &golden, &run}, second{"now", &run, &run};
  const Chart chart = ComparisonChart(loaded.scenario, first, second, comparison, WholeOf(run));
  for (const char* name : {"right_hand (golden)", "right_hand (now)"}) {
    const Row* row = RowOf(chart, name);
    ASSERT_TRUE(row) << name;
    ASSERT_EQ(row->hatches.size(), 1u) << name;
    EXPECT_NEAR(row->hatches[0].end_s - row->hatches[0].begin_s, 0.1, 1e-9);
  }
  EXPECT_TRUE(RowOf(chart, "milk on (golden)")->hatches.empty());
}

TEST(ComparisonSheet, HatchesTheThingThatDiffersOfThoseThatBeginTogether) {
  const auto& [loaded, run] = Of("bimanual/tray_with_three_things_is_carried");
  const auto is_of_milk = [](const grammar::NamedEvent& event) {
    return event.event == "supported_by" && event.roles[0].value == "milk";
  };
  const auto [golden, comparison] = GoldenLike(
      run, [&](auto& events) { std::ranges::find_if(events, is_of_milk)->interval.end -= 480; });
  const Side first{"golden", &golden, &run}, second{"now", &run, &run};
  const Chart chart = ComparisonChart(loaded.scenario, first, second, comparison, WholeOf(run));
  EXPECT_EQ(RowOf(chart, "milk on (golden)")->hatches.size(), 1u);
  EXPECT_TRUE(RowOf(chart, "cup on (golden)")->hatches.empty());
}

TEST(ComparisonSheet, SaysWhatIsOtherwiseAtTheSameTime) {
  const auto& [loaded, run] = Of("pick_and_place/milk_carton_wrap");
  const auto [golden, comparison] = GoldenLike(run, [](auto& events) {
    std::ranges::find(EventOf(events, "grasping").roles, "style", &grammar::Role::name)->value =
        "pinch";
  });
  const auto differences = BoundaryDifferences(comparison, WholeOf(run), loaded.scenario);
  ASSERT_EQ(differences.size(), 1u);
  EXPECT_EQ(differences[0].boundary, "grasping(right_hand, milk)");
  EXPECT_EQ(differences[0].how, "style: pinch -> wrap");
  const auto [later, both] = GoldenLike(run, [](auto& events) {
    grammar::NamedEvent& grasping = EventOf(events, "grasping");
    std::ranges::find(grasping.roles, "style", &grammar::Role::name)->value = "pinch";
    grasping.interval.end -= 48;
  });
  const auto two = BoundaryDifferences(both, WholeOf(run), loaded.scenario);
  ASSERT_EQ(two.size(), 1u);
  EXPECT_EQ(two[0].how, "100.0 ms later, style: pinch -> wrap");
}

TEST(ComparisonSheet, ShowsTheScenesOfEachDifference) {
  const auto& [loaded, run] = Of("pick_and_place/milk_carton_wrap");
  const auto [golden, comparison] = GoldenLike(run, [](auto& events) {
    EventOf(events, "transporting").interval.end -= 48;
    std::erase_if(events, [](const auto& event) { return event.event == "fixation"; });
  });
  const Side first{"golden", &golden, &run}, second{"now", &run, &run};
  ScenePainter painter;
  if (!CanDrawPictures()) GTEST_SKIP() << "built without pictures";
  ASSERT_EQ(painter.error(), "");
  const Sheet sheet =
      ComparisonSheet(loaded.scenario, first, second, comparison, WholeOf(run), {}, painter);
  ASSERT_EQ(sheet.rows.size(), 2u);
  EXPECT_EQ(sheet.rows[0].heading, "(b) end of transporting(right_hand, milk): 100.0 ms later");
  ASSERT_EQ(sheet.rows[0].tiles.size(), 3u);
  EXPECT_NE(sheet.rows[0].tiles[0].png, sheet.rows[0].tiles[1].png);
  EXPECT_TRUE(sheet.rows[0].tiles[1].caption.starts_with("now: "));
  ASSERT_EQ(sheet.rows[1].tiles.size(), 1u);
  EXPECT_TRUE(
      sheet.rows[1].tiles[0].caption.starts_with("(a) fixation(right_hand, milk)\nonly in now: "));
  EXPECT_EQ(sheet.chart->marks.size(), 2u);
  EXPECT_TRUE(RowOf(*sheet.chart, "milk on")) << "what both say is one row";
  Window later = WholeOf(run);
  later.from_s = 4;
  EXPECT_TRUE(
      ComparisonSheet(loaded.scenario, first, second, comparison, later, {}, painter).rows.empty());
}

}  // namespace
}  // namespace prehend::show
