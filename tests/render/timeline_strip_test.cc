// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "render/overlay.h"

namespace prehend::render {
namespace {

class TimelineStripTest : public testing::Test {
 protected:
  TimelineStripTest() : font_(Font::Read(kDefaultFontFile, &error_)) {}
  void SetUp() override { ASSERT_NE(font_, nullptr) << error_; }

  StripLayout Layout(const TimelineStrip& strip, int width_px = 1280, int height_px = 720) const {
    return LayOutStrip(strip, *font_, width_px, height_px);
  }

  std::string error_;
  std::unique_ptr<Font> font_;
};

TEST_F(TimelineStripTest, BarsStandAtTheirTimes) {
  const StripLayout layout = Layout({.begin_s = 0,
                                     .end_s = 4,
                                     .playhead_s = 2,
                                     .rows = {{"row", {{"first", 0, 1}, {"second", 1, 3}}}}});
  ASSERT_EQ(layout.lanes.size(), 1u);
  const StripLane& lane = layout.lanes[0];
  ASSERT_EQ(lane.bars.size(), 2u);
  EXPECT_NEAR(lane.bars[0].rect.x, lane.track.x, 1);
  EXPECT_NEAR(lane.bars[0].rect.width, lane.track.width / 4, 2);
  EXPECT_NEAR(lane.bars[1].rect.right(), lane.track.x + lane.track.width * 0.75f, 1);
  EXPECT_NEAR(layout.playhead_x, lane.track.x + lane.track.width / 2, 0.1f);
  EXPECT_EQ(layout.playhead_label, "2.00 s");
  EXPECT_EQ(lane.bars[0].name_place, NamePlace::kInside);
}

TEST_F(TimelineStripTest, ItSaysHowManyRowsAreLeftOut) {
  TimelineStrip strip{.end_s = 4, .rows = {{"row", {{"a", 0, 1}}}}};
  EXPECT_EQ(Layout(strip).note, "");
  strip.rows_left_out = 8;
  EXPECT_EQ(Layout(strip).note, "+ 8 more");
  strip.rows.assign(40, strip.rows[0]);
  const StripLayout layout = Layout(strip);
  EXPECT_EQ(layout.note, "+ " + std::to_string(48 - layout.lanes.size()) + " more");
}

TEST_F(TimelineStripTest, NamesWithoutRoomAreInALegend) {
  const Color red = {1, 0, 0}, blue = {0, 0, 1}, brown = {0.5f, 0.3f, 0.2f};
  StripRow phases{"phase", {}}, grasps{"grasp", {}};
  for (int i = 0; i < 40; ++i) {
    phases.segments.push_back({"reaching", 1.0 * i, i + 0.4, red});
    phases.segments.push_back({"transporting", i + 0.4, i + 0.9, blue});
    grasps.segments.push_back({i % 2 ? "red_cup" : "blue_cup", i + 0.3, i + 0.9, brown});
  }
  const StripLayout layout = Layout({.end_s = 40, .rows = {phases, grasps}});
  ASSERT_EQ(layout.legend.size(), 2u) << "brown means two things";
  EXPECT_EQ(layout.legend[0].name, "reaching");
  EXPECT_EQ(layout.legend[1].color, blue);
  EXPECT_LT(layout.legend[1].box.bottom(), layout.lanes[0].track.y);
  for (const StripBar& bar : layout.lanes[0].bars)
    EXPECT_EQ(bar.name_place, NamePlace::kNone) << bar.name;
  EXPECT_TRUE(Layout({.end_s = 4, .rows = {{"row", {{"a", 0, 3, red}}}}}).legend.empty());
}

TEST_F(TimelineStripTest, TextAndBarsGrowTogether) {
  const TimelineStrip strip{.end_s = 4, .rows = {{"row", {{"a", 0, 1}}}}};
  const StripLayout usual = LayOutStrip(strip, *font_, 1280, 720),
                    large = LayOutStrip(strip, *font_, 1280, 720, 2);
  EXPECT_NEAR(large.lanes.at(0).track.height, 2 * usual.lanes.at(0).track.height, 1e-3);
}

TEST_F(TimelineStripTest, NarrowBarsHaveTheirNamesAbove) {
  const StripLayout layout = Layout(
      {.begin_s = 0,
       .end_s = 10,
       .rows = {{"row", {{"reaching", 0, 2}, {"fixation", 2, 2.1}, {"picking_up", 2.1, 2.2}}}}});
  const auto& bars = layout.lanes.at(0).bars;
  EXPECT_EQ(bars[0].name_place, NamePlace::kInside);
  EXPECT_EQ(bars[1].name_place, NamePlace::kAbove);
  EXPECT_LT(bars[1].name_top + bars[1].name_size_px, bars[1].rect.y + 2);
  EXPECT_GE(bars[1].name_top, layout.panel.y);
  if (bars[2].name_place == NamePlace::kAbove) {
    EXPECT_GE(bars[2].name_left,
              bars[1].name_left + font_->Width("fixation", bars[1].name_size_px));
  }
}

TEST_F(TimelineStripTest, SegmentsThatOverlapInTimeGetLanes) {
  const StripLayout layout = Layout(
      {.end_s = 4,
       .rows = {{"contact", {{"a", 0, 2}, {"b", 1, 3}, {"c", 2, 4}}}, {"next", {{"d", 0, 4}}}}});
  ASSERT_EQ(layout.lanes.size(), 3u);
  EXPECT_EQ(layout.lanes[0].bars.size(), 2u) << "c follows a";
  EXPECT_EQ(layout.lanes[0].label, "contact");
  EXPECT_EQ(layout.lanes[1].label, "");
  EXPECT_EQ(layout.lanes[2].label, "next");
  for (std::size_t i = 1; i < layout.lanes.size(); ++i) {
    EXPECT_FALSE(layout.lanes[i].track.Overlaps(layout.lanes[i - 1].track));
  }
}

TEST_F(TimelineStripTest, PanelHoldsEverythingAndTheSceneKeepsItsShare) {
  for (const auto& [width, height] : {std::pair{1280, 720}, {960, 540}, {480, 360}, {3840, 2160}}) {
    TimelineStrip strip{.end_s = 5};
    for (int i = 0; i < 30; ++i)
      strip.rows.push_back({"row " + std::to_string(i), {{"name", 1, 3}}});
    const StripLayout layout = Layout(strip, width, height);
    EXPECT_GE(layout.lanes.size(), 3u);
    EXPECT_LT(layout.reserved_px(), height * 0.45);
    for (const StripLane& lane : layout.lanes) {
      EXPECT_GE(lane.track.y, layout.panel.y);
      EXPECT_LE(lane.track.bottom(), layout.axis_top);
      EXPECT_LE(lane.track.right(), layout.panel.right());
    }
    EXPECT_LT(layout.axis_top, layout.panel.bottom());
    EXPECT_LT(layout.panel.bottom(), static_cast<float>(height));
  }
}

TEST_F(TimelineStripTest, TicksAreRoundAndDoNotCrowd) {
  for (const double end_s : {0.05, 0.7, 4.8, 61.0, 9000.0}) {
    const StripLayout layout = Layout({.end_s = end_s, .rows = {{"row", {{"x", 0, end_s}}}}});
    float last = -1000;
    int labelled = 0;
    for (const StripTick& tick : layout.ticks) {
      if (tick.label.empty()) continue;
      ++labelled;
      EXPECT_GT(tick.x - last, font_->Width(tick.label, 12)) << end_s;
      last = tick.x;
    }
    EXPECT_GE(labelled, 3) << end_s;
    EXPECT_LT(layout.ticks.size(), 150u) << end_s;
    EXPECT_EQ(layout.ticks.front().label.substr(0, 1), "0") << end_s;
  }
}

TEST_F(TimelineStripTest, NothingToShowIsNoStrip) {
  const double nan = std::nan("");
  const StripRow row = {"row", {{"x", 0, 1}}};
  const TimelineStrip cases[] = {{.end_s = 1},
                                 {.begin_s = 2, .end_s = 1, .rows = {row}},
                                 {.begin_s = 1, .end_s = 1, .rows = {row}},
                                 {.begin_s = nan, .end_s = 1, .rows = {row}},
                                 {.begin_s = 0, .end_s = 1e300, .rows = {row}}};
  for (const TimelineStrip& strip : cases) EXPECT_EQ(Layout(strip).reserved_px(), 0);
  EXPECT_EQ(Layout({.end_s = 1, .rows = {row}}, 64, 64).reserved_px(), 0) << "too small";
}

TEST_F(TimelineStripTest, SegmentsOutsideOrWithoutSenseAreLeftOut) {
  const double nan = std::nan("");
  const StripLayout layout = Layout(
      {.begin_s = 1,
       .end_s = 2,
       .playhead_s = 5,
       .rows = {
           {"row",
            {{"before", 0, 0.5}, {"backwards", 1.8, 1.2}, {"nan", nan, 1.5}, {"here", 1.2, 9}}}}});
  ASSERT_EQ(layout.lanes.at(0).bars.size(), 1u);
  EXPECT_LE(layout.lanes[0].bars[0].rect.right(), layout.lanes[0].track.right() + 1);
  EXPECT_TRUE(layout.playhead_label.empty()) << "the playhead is outside";
}

}  // namespace
}  // namespace prehend::render
