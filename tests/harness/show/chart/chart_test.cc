// SPDX-License-Identifier: Apache-2.0
#include "harness/show/chart/chart.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <pugixml.hpp>
#include <string>
#include <vector>

namespace prehend::show {
namespace {

TEST(Chart, TicksAreRound) {
  using V = std::vector<double>;
  EXPECT_EQ(RoundTicks(0, 5, 5), (V{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(RoundTicks(0, 1, 2), (V{0, 0.5, 1}));
  EXPECT_EQ(RoundTicks(-3, 12, 4), (V{0, 5, 10}));
  EXPECT_EQ(RoundTicks(100, 1000, 3), (V{500, 1000}));
}

Chart Example() {
  return {.title = "a < b",
          .from_s = 1,
          .to_s = 3,
          .rows = {{"hand", {{0, 1.5, "before", 0x112233}, {4, 5, "after", 0x445566}}}},
          .panels = {{"height, m", {{"cup", {{0, 9}, {1, 0}, {2, 1}, {4, 9}}}}}}};
}

TEST(Chart, ShowsWhatLiesInItsTime) {
  pugi::xml_document svg;
  ASSERT_TRUE(svg.load_string(ChartSvg(Example()).c_str()));
  const auto with = [&](const char* name, const char* key, const char* value) {
    return svg.child("svg").find_child([&](pugi::xml_node node) {
      return std::strcmp(node.name(), name) == 0 &&
             std::strcmp(node.attribute(key).value(), value) == 0;
    });
  };
  EXPECT_TRUE(with("rect", "fill", "#112233")) << "cut at the begin";
  EXPECT_FALSE(with("rect", "fill", "#445566"));
  EXPECT_TRUE(with("rect", "fill", "#FFFFFF")) << "the ground";
  const std::string points = with("polyline", "fill", "none").attribute("points").value();
  EXPECT_EQ(std::count(points.begin(), points.end(), ','), 2) << points;
}

TEST(Chart, MayHaveNoGround) {
  EXPECT_EQ(ChartSvg(Example(), {.transparent = true}).find("\"100%\""), std::string::npos);
  EXPECT_NE(ChartSvg(Example()).find("\"100%\""), std::string::npos);
  EXPECT_NE(ChartSvg(Example()).find("a &lt; b"), std::string::npos);
}

TEST(Chart, NamesTheColoursOfShortBarsAndInterruptsCurves) {
  Chart chart{.to_s = 10, .rows = {{"hand", {{1, 1.01, "fixation", 0x112233, "fixation"}}}}};
  EXPECT_NE(ChartSvg(chart).find(">fixation<"), std::string::npos);
  chart.panels = {{"height, m", {{"", {{0, 1}, {1, 1}, {2, NAN}, {3, 1}, {4, 2}}}}}};
  const std::string svg = ChartSvg(chart);
  EXPECT_NE(svg.find("<polyline"), svg.rfind("<polyline"));
}

TEST(Chart, ALegendThatIsTooLongGoesOnInTheNextLine) {
  Chart chart{.to_s = 100, .rows = {{"hand", {}}}};
  for (int i = 0; i < 12; ++i) {
    const std::string kind = "a_rather_long_name_" + std::to_string(i);
    chart.rows[0].bars.push_back({8.0 * i, 8.0 * i + 0.1, kind, 0x112233, kind});
  }
  pugi::xml_document svg;
  ASSERT_TRUE(svg.load_string(ChartSvg(chart, {.width_px = 500}).c_str()));
  const auto keys = svg.select_nodes("//text[starts-with(., 'a_rather_long_name_')]");
  ASSERT_EQ(keys.size(), 12u);
  const auto at = [](const auto& key, const char* side) {
    return key.node().attribute(side).as_double();
  };
  for (const auto& key : keys) {
    EXPECT_LT(at(key, "x") + 0.62 * 12 * 21, 500) << "it is not cut";
    EXPECT_LT(at(key, "y"), svg.child("svg").attribute("height").as_double());
  }
  EXPECT_LT(at(keys[0], "y"), at(keys[11], "y"));
}

TEST(Chart, NothingIsCutOrOverprintedWhereItIsNarrow) {
  const std::vector<Curve> curves = {{"right_hand", {{0, 1}}}, {"left_hand", {{0, 1}}}};
  const Chart chart{.title = "plate_of_a_kilogram_twists_out_of_one_hand, pick_and_place",
                    .rows = {{"right_hand: grasping (pick_and_place)", {{0, 1, "milk"}}}},
                    .panels = {{"distance to what is seen, m", curves}, {"grip", {{"", {}}}}}};
  for (const double width_px : {170.0, 227.0, 336.0, 900.0}) {
    pugi::xml_document svg;
    ASSERT_TRUE(svg.load_string(ChartSvg(chart, {.width_px = width_px, .text_px = 9.3}).c_str()));
    struct Box {
      double left, right, base;
    };
    std::vector<Box> boxes;
    for (const auto& node : svg.select_nodes("//text")) {
      const pugi::xml_node text = node.node();
      const std::string anchor = text.attribute("text-anchor").value();
      const bool bold = std::strcmp(text.attribute("font-weight").value(), "bold") == 0;
      const double wide =
          (bold ? 0.68 : 0.6) * 9.3 * static_cast<double>(std::strlen(text.child_value()));
      const double x = text.attribute("x").as_double(), left = anchor == "end"      ? x - wide
                                                               : anchor == "middle" ? x - wide / 2
                                                                                    : x;
      EXPECT_GE(left, 0) << text.child_value() << " at " << width_px;
      EXPECT_LE(left + wide, width_px) << text.child_value() << " at " << width_px;
      const Box box{left, left + wide, text.attribute("y").as_double()};
      for (const Box& other : boxes)
        EXPECT_TRUE(box.left >= other.right || other.left >= box.right ||
                    std::abs(box.base - other.base) > 6)
            << text.child_value() << " at " << width_px;
      boxes.push_back(box);
    }
  }
}

TEST(Chart, TheLastTimeIsNotCutAndAShortEventIsSeen) {
  const Chart chart{.to_s = 100000, .rows = {{"hand", {{5, 5.1, "", 0x112233}}}}};
  pugi::xml_document svg;
  ASSERT_TRUE(svg.load_string(ChartSvg(chart, {.width_px = 400}).c_str()));
  const pugi::xml_node last = svg.select_node("//text[. = '100000']").node();
  EXPECT_LE(last.attribute("x").as_double() + 0.6 * 12 * 6 / 2, 400);
  const pugi::xml_node bar = svg.select_node("//rect[@fill = '#112233']").node();
  EXPECT_GE(bar.attribute("width").as_double(), 2);
  EXPECT_STREQ(bar.attribute("stroke").value(), "none") << "no frame covers it";
}

TEST(Chart, LongNamesThatBeginAlikeAreToldApart) {
  const std::string name(200, 'x');
  const std::string svg =
      ChartSvg({.rows = {{name + "_first", {}}, {name + "_second", {}}}}, {.width_px = 400});
  EXPECT_NE(svg.find("_first<"), std::string::npos);
  EXPECT_NE(svg.find("_second<"), std::string::npos);
}

TEST(Chart, LinesAreBrokenAtBlanksElseInNames) {
  using Lines = std::vector<std::string>;
  EXPECT_EQ(BrokenLines("one two", 7), Lines{"one two"});
  EXPECT_EQ(BrokenLines("one two three", 8), (Lines{"one two", "three"}));
  EXPECT_EQ(BrokenLines("contact(milk, right_hand)", 13), (Lines{"contact(milk,", "right_hand)"}));
  EXPECT_EQ(BrokenLines("pick_and_place(hand)", 15), (Lines{"pick_and_place", "(hand)"}));
  EXPECT_EQ(BrokenLines("\u00e4\u00e4\u00e4", 3), (Lines{"\u00e4", "\u00e4", "\u00e4"}));
}

TEST(Chart, OfNothingIsEmptyButValid) {
  pugi::xml_document svg;
  EXPECT_TRUE(svg.load_string(ChartSvg({.panels = {{"nothing", {{"", {}}}}}}).c_str()));
}

}  // namespace
}  // namespace prehend::show
