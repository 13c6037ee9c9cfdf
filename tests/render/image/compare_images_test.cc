// SPDX-License-Identifier: Apache-2.0
// The gate of golden pictures: which faults it must catch, and what it must let pass.
#include <gtest/gtest.h>

#include "tests/render/demo_picture.h"

namespace prehend::render {
namespace {

Image Noisy(Image image, int step, int amplitude) {
  for (std::size_t i = 0; i < image.rgb.size(); i += static_cast<std::size_t>(3 * step))
    image.rgb[i] = static_cast<std::uint8_t>(image.rgb[i] > 127 ? image.rgb[i] - amplitude
                                                                : image.rgb[i] + amplitude);
  return image;
}

class CompareImagesTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(painter_.error(), "");
    picture_ = DemoPicture(scene_);
    picture_.width_px = 960;
    picture_.height_px = 540;
    golden_ = painter_.Draw(picture_);
    ASSERT_FALSE(golden_.rgb.empty());
  }
  ImageDifference Now() { return CompareImages(golden_, painter_.Draw(picture_)); }

  Painter painter_;
  physics::Scene scene_ = DemoScene();
  Picture picture_;
  Image golden_;
};

TEST_F(CompareImagesTest, TheSamePictureIsEqualToTheBit) {
  EXPECT_EQ(Now().pixels, 0u);
  EXPECT_TRUE(Now().AreEqual());
}

TEST_F(CompareImagesTest, APhaseColorOffByTwentyIsCaught) {
  picture_.path[0].color.x() -= 20.0f / 255;
  EXPECT_FALSE(Now().AreEqual());
}

TEST_F(CompareImagesTest, AChangedLabelIsCaught) {
  picture_.body_labels[1] = "milc";
  EXPECT_FALSE(Now().AreEqual());
}

TEST_F(CompareImagesTest, ABoundaryMovedByTwentyMillisecondsIsCaught) {
  picture_.strip.rows[0].segments[0].end_s += 0.02;
  EXPECT_FALSE(Now().AreEqual());
}

TEST_F(CompareImagesTest, APathEndMovedByTwoMillimetresIsCaught) {
  picture_.path.back().points_m.back().z() += 0.002f;
  picture_.path[0].points_m.front().z() += 0.002f;
  EXPECT_FALSE(Now().AreEqual());
}

TEST_F(CompareImagesTest, AMissingThingIsCaughtAndItsPlaceSaid) {
  scene_.bodies[4].shapes.clear();
  picture_.body_labels[4] = "";
  const ImageDifference difference = Now();
  EXPECT_FALSE(difference.AreEqual());
  EXPECT_LT(difference.right - difference.left, 960 / 2) << "the apple, not the picture";
}

TEST_F(CompareImagesTest, AnotherProcessorPasses) {
  // Measured with and without fused multiply-add: 0.45 % of the pixels, by at most 10 of 255.
  EXPECT_TRUE(CompareImages(golden_, Noisy(golden_, 220, 10)).AreEqual());
  EXPECT_FALSE(CompareImages(golden_, Noisy(golden_, 220, 20)).AreEqual());
}

TEST_F(CompareImagesTest, AThingMovedByTwoCentimetresColorsLessThanATwentieth) {
  picture_.snapshot.bodies[4].X_WB.p_m.x() += 0.02;
  const ImageDifference difference = Now();
  EXPECT_FALSE(difference.AreEqual());
  EXPECT_LT(difference.pixels, 960u * 540 / 20);
}

TEST(CompareImagesOfSizes, OthersAreNotCompared) {
  const Image small{1, 1, {0, 0, 0}}, wide{2, 1, {0, 0, 0, 0, 0, 0}};
  EXPECT_FALSE(CompareImages(small, wide).AreEqual());
}

}  // namespace
}  // namespace prehend::render
