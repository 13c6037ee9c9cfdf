// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <pugixml.hpp>

#include "harness/show/figures/scene_tiles.h"

namespace prehend::show {
namespace {

double Number(const pugi::xpath_node& node, const char* key) {
  return node.node().attribute(key).as_double();
}

TEST(Sheet, TilesAreInRowsAboveTheChart) {
  const Sheet sheet{
      .title = "title",
      .rows = {{.heading = "heading",
                .tiles = {{"png", "(a) one\n1 s"}, {"png", "(b) two\n2 s"}, {"png", "(c)"}},
                .columns = 2}},
      .chart = Chart{.rows = {{"hand", {{0, 1, "bar"}}}}, .marks = {{0.5, "a"}, {0.5, "b"}}},
      .note = "note",
      .legend = {{"thumb", 0x112233}}};
  pugi::xml_document svg;
  ASSERT_TRUE(svg.load_string(SheetSvg(sheet).c_str()));
  const auto images = svg.select_nodes("//image");
  ASSERT_EQ(images.size(), 3u);
  EXPECT_STREQ(images[0].node().attribute("xlink:href").value(), "data:image/png;base64,cG5n");
  EXPECT_EQ(Number(images[0], "y"), Number(images[1], "y"));
  EXPECT_LT(Number(images[0], "x"), Number(images[1], "x"));
  EXPECT_LT(Number(images[1], "y"), Number(images[2], "y"));
  EXPECT_NEAR(Number(images[0], "width"), TileWidth({}, 2), 0.01);
  const auto y_of = [&](const char* text) {
    const auto node = svg.select_node(("//text[.='" + std::string(text) + "']").c_str());
    EXPECT_TRUE(node) << text;
    return Number(node, "y");
  };
  EXPECT_LT(y_of("title"), y_of("heading"));
  EXPECT_LT(Number(images[0], "y") + Number(images[0], "height"), y_of("(a) one"));
  EXPECT_LT(y_of("(a) one"), y_of("1 s"));
  EXPECT_LT(y_of("1 s"), Number(images[2], "y")) << "captions are between the rows";
  EXPECT_LT(y_of("(c)"), y_of("note"));
  EXPECT_LT(y_of("note"), svg.child("svg").attribute("height").as_double());
  y_of("thumb");
  const auto letters = svg.select_nodes("//text[.='a' or .='b']");
  ASSERT_EQ(letters.size(), 2u);
  EXPECT_LT(Number(letters[0], "x") + 5, Number(letters[1], "x")) << "they do not overlap";
}

TEST(Sheet, ACaptionIsBrokenWhereItsTileEnds) {
  const Sheet sheet{
      .rows = {{.tiles = {{"png", "(a) putting_down begins near the place"}}, .columns = 3}}};
  const std::string svg = SheetSvg(sheet, {.width_px = 336, .text_px = 9.3});
  EXPECT_NE(svg.find(">(a) putting_down<"), std::string::npos) << svg;
  EXPECT_NE(svg.find(">begins near the<"), std::string::npos) << svg;
  const std::string word =
      SheetSvg({.rows = {{.tiles = {{"png", "pick_and_place(right_hand, milk)"}}, .columns = 3}}},
               {.width_px = 336, .text_px = 9.3});
  EXPECT_NE(word.find(">pick_and_place<"), std::string::npos) << word;
  EXPECT_NE(word.find(">(right_hand,<"), std::string::npos) << word;
}

TEST(Sheet, DrawingsStandBesideEachOther) {
  const std::string one = SheetSvg({.title = "one"}), two = SheetSvg({.title = "two", .note = "n"});
  pugi::xml_document svg;
  ASSERT_TRUE(svg.load_string(BesideEachOther({one, two}, {}, 2).c_str()));
  EXPECT_EQ(svg.child("svg").attribute("width").as_double(), 1800);
  const auto parts = svg.select_nodes("/svg/svg");
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(Number(parts[1], "x"), 900);
  EXPECT_EQ(svg.child("svg").attribute("height").as_double(), Number(parts[1], "height"));
  ASSERT_TRUE(svg.load_string(BesideEachOther({one, two}, {}, 1).c_str()));
  const auto below = svg.select_nodes("/svg/svg");
  EXPECT_EQ(svg.child("svg").attribute("width").as_double(), 900);
  EXPECT_EQ(Number(below[1], "x"), 0);
  EXPECT_EQ(Number(below[1], "y"), Number(below[0], "height"));
}

TEST(Sheet, AHatchIsWithinItsTimeAndRow) {
  const Chart chart{.to_s = 10, .rows = {{"hand", {}, {{2, 3}, {40, 50}}}}};
  pugi::xml_document svg;
  ASSERT_TRUE(svg.load_string(ChartSvg(chart).c_str()));
  EXPECT_EQ(svg.select_nodes("//path").size(), 1u) << "the other one is outside";
}

TEST(Sheet, LettersGoOnAfterZ) {
  EXPECT_EQ(LetterOf(0), "a");
  EXPECT_EQ(LetterOf(25), "z");
  EXPECT_EQ(LetterOf(26), "aa");
}

}  // namespace
}  // namespace prehend::show
