// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "harness/measure/sweep/sweep.h"

namespace prehend::measure {
namespace {

Axis AxisOf(const std::string& text) {
  std::string problem;
  const auto axis = ParseAxis(text, problem);
  EXPECT_TRUE(axis) << problem;
  return axis.value_or(Axis{});
}

std::string ProblemOf(const std::string& text) {
  std::string problem;
  EXPECT_FALSE(ParseAxis(text, problem)) << text;
  return problem;
}

/// Points of a grid with these scores, the last axis the fastest.
std::vector<SweepPoint> Points(const std::vector<Axis>& axes, const std::vector<double>& scores) {
  std::vector<SweepPoint> points;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    SweepPoint& point = points.emplace_back();
    point.f1 = scores[i];
    const std::size_t columns = axes.back().values.size();
    point.at = axes.size() == 1 ? std::vector{i} : std::vector{i / columns, i % columns};
  }
  return points;
}

TEST(SweepAxis, GoesEvenlyFromTheFirstValueToTheLast) {
  const Axis axis = AxisOf("reach_radius=10cm..50cm:5");
  EXPECT_EQ(axis.parameter, "reach_radius");
  ASSERT_EQ(axis.values.size(), 5u);
  EXPECT_EQ(axis.ValueText(0), "10 cm");
  EXPECT_EQ(axis.ValueText(1), "20 cm");
  EXPECT_EQ(axis.ValueText(4), "50 cm");
  EXPECT_EQ(AxisOf("grip_on=0.1..0.7:7").ValueText(1), "0.2");
}

TEST(SweepAxis, SaysWhatIsWrong) {
  EXPECT_EQ(ProblemOf("reach_radius=10cm..50mm:5"),
            "'reach_radius=10cm..50mm:5' goes from 'cm' to 'mm': both ends need the same unit");
  for (const char* bad : {"x", "x=1", "x=1..2", "x=1..2:1", "x=1..2:2b", "=1..2:3", "x=a..2:3"})
    EXPECT_NE(ProblemOf(bad).find("wanted NAME=FROM..TO:COUNT"), std::string::npos) << bad;
}

TEST(SweepCsv, WhatIsOfNothingHasADash) {
  const std::vector<Axis> axes = {AxisOf("x=0..1:2")};
  std::vector<SweepPoint> points = Points(axes, {0, 1});
  points[0].missed = 2;
  points[0].begin_ms = points[0].end_ms = points[0].latency_ms =
      std::numeric_limits<double>::quiet_NaN();
  points[1].begin_ms = -1.5;
  EXPECT_EQ(CsvText(axes, points),
            "x,f1,correct,extra,missed,begin_error_ms,end_error_ms,latency_ms\n"
            "0,0.000000,0,0,2,-,-,-\n1,1.000000,0,0,0,-1.500,0.000,0.000\n");
  points[1].f1 = 0;
  points[0].f1 = 1;
  EXPECT_NE(RobustSettingsText(axes, {.points = points}, 0.01)
                .find("(F1 100.00 %, begin -, end -, latency -)"),
            std::string::npos);
}

TEST(SweepRobustSettings, NobodyPicksAnEdge) {
  const std::vector<Axis> axes = {AxisOf("x=0..6:7")};
  // The best is a lonely peak; the settings around 4 are nearly as good.
  const auto points = Points(axes, {0.5, 0.90, 0.5, 0.899, 0.898, 0.899, 0.4});
  const RobustSettings robust = FindRobustSettings(axes, points, 0.005);
  EXPECT_EQ(robust.best, 0.90);
  EXPECT_EQ(robust.chosen, 4u);
  EXPECT_EQ(robust.steps, 2u);
  EXPECT_EQ(robust.members, (std::vector<std::size_t>{3, 4, 5}));
  EXPECT_EQ(FindRobustSettings(axes, points, 0).chosen, 1u);
}

TEST(SweepRobustSettings, OfTwoParametersHangsTogether) {
  const std::vector<Axis> axes = {AxisOf("x=0..4:5"), AxisOf("y=0..4:5")};
  const auto points = Points(axes, {0, 0, 0, 0, 0,  //
                                    0, 1, 1, 1, 0,  //
                                    0, 1, 1, 1, 0,  //
                                    0, 1, 1, 1, 0,  //
                                    1, 0, 0, 0, 1});
  const RobustSettings robust = FindRobustSettings(axes, points, 0.01);
  EXPECT_EQ(robust.chosen, 12u);
  EXPECT_EQ(robust.members.size(), 9u);
  SweepResult result{
      .points = points, .episodes = 3, .measure = {}, .label_warning = {}, .left_out = {}};
  const std::string text = RobustSettingsText(axes, result, 0.01);
  EXPECT_NE(text.find("x: 1 to 3"), std::string::npos) << text;
  EXPECT_NE(text.find("farthest from its edge, 2 steps: x = 2 y = 2"), std::string::npos) << text;
  EXPECT_TRUE(CsvText(axes, points).starts_with("x,y,f1,correct,extra,missed,"));
  const std::string svg = HeatMapSvg(axes, points, robust);
  EXPECT_NE(svg.find("stroke=\"#d00\""), std::string::npos);
  EXPECT_EQ(std::count(svg.begin(), svg.end(), '\n') > 50, true);
}

TEST(SweepRobustSettings, TheMiddleOfAPlateauIsChosen) {
  const auto chosen = [](int rows, int columns, std::vector<double> scores) {
    const std::vector<Axis> axes = {AxisOf("x=0..8:" + std::to_string(rows)),
                                    AxisOf("y=0..8:" + std::to_string(columns))};
    scores.resize(static_cast<std::size_t>(rows * columns), 1);
    const RobustSettings robust = FindRobustSettings(axes, Points(axes, scores), 0.01);
    return std::pair(robust.chosen, robust.steps);
  };
  using Chosen = std::pair<std::size_t, std::size_t>;
  EXPECT_EQ(chosen(5, 5, {}), Chosen(12, 3));
  EXPECT_EQ(chosen(3, 9, {}), Chosen(13, 2)) << "all of 10 to 16 are 2 steps from the border";
  EXPECT_EQ(chosen(9, 3, {}), Chosen(13, 2));
  EXPECT_EQ(chosen(2, 5, {}), Chosen(2, 1)) << "each setting is at the border";
  EXPECT_EQ(chosen(2, 5, {1, 0.995}), Chosen(2, 1)) << "the middle of what is as good";
  EXPECT_EQ(chosen(3, 9, {1, 1, 1, 1,   1, 1, 1, 1, 0.5, 1, 1, 1, 1,  1,
                          1, 1, 1, 0.5, 1, 1, 1, 1, 1,   1, 1, 1, 0.5}),
            Chosen(12, 2));
}

TEST(SweepRobustSettings, AtAnEdgeIsAWarning) {
  const std::vector<Axis> axes = {AxisOf("x=0..4:5"), AxisOf("y=1cm..3cm:3")};
  const auto points = Points(axes, {0, 0, 0,  //
                                    0, 0, 0,  //
                                    0, 0, 0,  //
                                    0, 0, 0,  //
                                    1, 1, 1});
  const SweepResult result{
      .points = points, .episodes = 3, .measure = {}, .label_warning = {}, .left_out = {}};
  const std::string text = RobustSettingsText(axes, result, 0.01);
  EXPECT_NE(text.find("\nwarning: x is best at the edge of what was tried, 4; try values beyond "
                      "it\n"),
            std::string::npos)
      << text;
  EXPECT_EQ(text.find("warning: y"), std::string::npos) << "it has no effect: " << text;
  const SweepResult one{.points = Points({axes[0]}, {0, 0, 1, 0, 0}),
                        .episodes = 1,
                        .measure = {},
                        .label_warning = {},
                        .left_out = {}};
  const std::string inside = RobustSettingsText({axes[0]}, one, 0.01);
  EXPECT_NE(inside.find("named last: 1 setting\n"), std::string::npos) << inside;
  EXPECT_EQ(inside.find("warning"), std::string::npos) << inside;
}

TEST(SweepRobustSettings, WhereEverySettingScoresZeroNoneIsTheBest) {
  const std::vector<Axis> axes = {AxisOf("x=0..2:3")};
  const auto points = Points(axes, {0, 0, 0});
  EXPECT_TRUE(FindRobustSettings(axes, points, 0.005).members.empty());
  const SweepResult result{
      .points = points, .episodes = 1, .measure = {}, .label_warning = {}, .left_out = {}};
  const std::string text = RobustSettingsText(axes, result, 0.005);
  EXPECT_NE(text.find("every one scores 0"), std::string::npos) << text;
  EXPECT_EQ(text.find("farthest"), std::string::npos) << text;
}

}  // namespace
}  // namespace prehend::measure
