// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "harness/scenario/scenario/scenario.h"
#include "harness/show/pictures/pictures.h"
#include "tests/harness/show/figures/played.h"

namespace prehend::show {
namespace {

class Scenes : public testing::Test {
 protected:
  void SetUp() override {
    if (!CanDrawPictures()) GTEST_SKIP() << "built without pictures";
    ASSERT_EQ(painter_.error(), "");
  }
  DrawnScene At(const std::string& at, const std::string& camera = "action",
                PictureFormat format = {}) {
    scenario::PictureYaml entry;
    entry.at.value = at;
    entry.camera.value = camera;
    format.width_px = 160;
    format.height_px = 120;
    return painter_.Draw(played_.loaded.scenario, played_.run, entry, format);
  }

  const Played& played_ = Of("pick_and_place/milk_carton_wrap");
  ScenePainter painter_;
};

TEST_F(Scenes, ArePngsOfTheirMoment) {
  const DrawnScene scene = At("reaching.begin");
  EXPECT_EQ(scene.png.substr(1, 3), "PNG");
  EXPECT_NEAR(scene.time_s, 0.0708, 0.001);
  EXPECT_EQ(scene.missed, "");
  EXPECT_NE(At("sliding.begin").missed, "");
}

TEST_F(Scenes, DifferWhereSomethingMoved) {
  const std::string one = At("1").png, other = At("2.5").png;
  const SceneDifference difference = DifferenceOf(one, other);
  EXPECT_GT(difference.share, 0.01);
  EXPECT_LT(difference.share, 0.5);
  EXPECT_EQ(DifferenceOf(one, one).share, 0);
  EXPECT_EQ(DifferenceOf(one, "no picture").png, "");
}

TEST_F(Scenes, ACameraIsATextThatGivesTheSameView) {
  scenario::PictureYaml entry;
  entry.at.value = "1";
  entry.camera.value = "action";
  const std::string camera = ScenePainter::CameraOf(played_.loaded.scenario, played_.run, entry,
                                                    {.width_px = 160, .height_px = 120});
  EXPECT_TRUE(scenario::ParseOwnCamera(camera)) << camera;
  EXPECT_LT(DifferenceOf(At("1").png, At("1", camera).png).share, 0.01);
  EXPECT_GT(DifferenceOf(At("1").png, At("1", "top").png).share, 0.3);
}

TEST_F(Scenes, FrameWhatIsAskedFor) {
  const PictureFormat near{.framed_from_s = 1, .framed_to_s = 1.1};
  EXPECT_GT(DifferenceOf(At("1").png, At("1", "action", near).png).share, 0.1);
  PictureFormat with_milk;
  with_milk.framed = {"right_hand", "milk"};
  EXPECT_GT(DifferenceOf(At("0", "hand").png, At("0", "hand", with_milk).png).share, 0.05);
}

TEST_F(Scenes, ColourHandsByTheirSensors) {
  const PictureFormat coloured{.sensor_colors = {{"thumb", 0x0000FF}}};
  const double share = DifferenceOf(At("2", "hand").png, At("2", "hand", coloured).png).share;
  EXPECT_GT(share, 0.001);
  EXPECT_LT(share, 0.1) << "only the thumb";
}

TEST_F(Scenes, ATransparentOneHasAlpha) {
  constexpr std::size_t kColorType = 25;  // in the header of a PNG
  EXPECT_EQ(At("1").png[kColorType], 2);
  EXPECT_EQ(At("1", "action", {.transparent = true}).png[kColorType], 6);
}

}  // namespace
}  // namespace prehend::show
