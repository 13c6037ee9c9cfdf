// SPDX-License-Identifier: Apache-2.0
#include "harness/show/figures/scene_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "harness/scenario/scenario/scenario.h"
#include "harness/show/pictures/pictures.h"
#include "tests/harness/show/figures/played.h"

namespace prehend::show {
namespace {

class SceneTiles : public testing::Test {
 protected:
  void SetUp() override {
    if (!CanDrawPictures()) GTEST_SKIP() << "built without pictures";
    ASSERT_EQ(painter_.error(), "");
  }
  const Played& played_ = Of("pick_and_place/milk_carton_wrap");
  const scenario::Scenario& scenario_ = played_.loaded.scenario;
  ScenePainter painter_;
};

TEST_F(SceneTiles, KeyFramesHaveLettersAndSizesOfTheirTiles) {
  const auto moments = KeyMoments(played_.run, WholeOf(played_.run), 4);
  const Sheet sheet = KeyFrameSheet(scenario_, played_.run, moments, {}, painter_);
  ASSERT_EQ(sheet.rows.size(), 1u);
  ASSERT_EQ(sheet.rows[0].tiles.size(), 4u);
  EXPECT_EQ(sheet.rows[0].columns, 4);
  EXPECT_EQ(sheet.rows[0].tiles[0].caption, "(a) reaching begins\n0.07 s");
  std::set<std::string> pictures;
  for (const Tile& tile : sheet.rows[0].tiles) pictures.insert(tile.png);
  EXPECT_EQ(pictures.size(), 4u) << "each shows something else";
}

TEST_F(SceneTiles, AKeyFrameHasTheWayThatLeadsToIt) {
  const auto tile = [&](KeyMoment moment) {
    TileRow row;
    AddKeyFrames(scenario_, played_.run, {std::move(moment)}, {}, painter_, row);
    return row.tiles[0].png;
  };
  const KeyMoment end{.time_s = 3.4, .caption = "c", .camera = {}, .track_s = 1};
  KeyMoment kept = end;
  kept.keeps_track = true;
  EXPECT_NE(tile(end), tile(kept)) << "what led to the put-down is pale green";
}

TEST_F(SceneTiles, AChartSaysWhenItsScenesAre) {
  const Sheet sheet = WithScenes({.title = "t", .to_s = 5}, scenario_, played_.run,
                                 {{.time_s = 1, .caption = "one"}, {.time_s = 2}}, {}, painter_);
  ASSERT_EQ(sheet.chart->marks.size(), 2u);
  EXPECT_EQ(sheet.chart->marks[1].letter, "b");
  EXPECT_EQ(sheet.chart->marks[1].time_s, 2);
  EXPECT_EQ(sheet.rows[0].tiles[0].caption, "(a) one\n1.00 s");
  EXPECT_EQ(sheet.rows[0].tiles[1].caption, "(b) 2.00 s");
  EXPECT_EQ(sheet.title, "t") << "above the scenes, not below them";
  EXPECT_EQ(sheet.chart->title, "");
}

TEST_F(SceneTiles, TheViewOfAWideSceneIsNearer) {
  const auto near = scenario::ParseOwnCamera(WideView(scenario_, played_.run, 0, {}));
  const auto front =
      scenario::ParseOwnCamera(WideView(scenario_, played_.run, 0, {.camera = "front"}));
  ASSERT_TRUE(near && front);
  EXPECT_LT(near->view_deg, front->view_deg);
}

TEST_F(SceneTiles, SensorsThatTouchHaveAColourEach) {
  const auto held = LongestGrasp(scenario_, played_.run);
  const Sheet sheet = GraspSheet({{&scenario_, &played_.run, *held}}, {}, painter_);
  ASSERT_EQ(sheet.legend.size(), 2u);
  EXPECT_EQ(sheet.legend[0].first, "fingers");
  EXPECT_NE(sheet.legend[0].second, sheet.legend[1].second);
  EXPECT_EQ(sheet.rows[0].tiles[0].caption, "(a) wrap\nfingers, thumb");
}

TEST(LongestLooks, AreInTheOrderOfTime) {
  const auto& [loaded, run] = Of("gaze/eyes_lead_the_hand");
  const auto looks = LongestLooks(loaded.scenario, run, WholeOf(run), 3);
  ASSERT_EQ(looks.size(), 3u);
  EXPECT_TRUE(std::ranges::is_sorted(looks, {}, &KeyMoment::time_s));
  EXPECT_TRUE(looks[0].caption.starts_with("anna sees milk for 1.9")) << looks[0].caption;
}

}  // namespace
}  // namespace prehend::show
