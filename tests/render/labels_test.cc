// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "render/overlay.h"
#include "tests/render/demo_picture.h"

namespace prehend::render {
namespace {

class LabelsTest : public testing::Test {
 protected:
  LabelsTest() : font_(Font::Read(kDefaultFontFile, &error_)) {}
  void SetUp() override { ASSERT_NE(font_, nullptr) << error_; }

  std::vector<PlacedLabel> Place(const std::vector<LabelRequest>& requests) const {
    return PlaceLabels(requests, {.area = area_, .forbidden = {title_}, .avoid = avoid_}, *font_,
                       1);
  }

  std::string error_;
  std::unique_ptr<Font> font_;
  Rect area_ = {5, 5, 800, 500};
  Rect title_ = {10, 10, 200, 30};
  std::vector<Eigen::Vector2f> avoid_;
};

TEST_F(LabelsTest, NeverOverlapAndStayInside) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> x(10, 795), y(10, 495);
    std::vector<LabelRequest> requests;
    for (int i = 0; i < 15; ++i)
      requests.push_back({"thing_" + std::to_string(i), Hex(0), {x(random), y(random)}, {}});
    const std::vector<PlacedLabel> placed = Place(requests);
    EXPECT_GE(placed.size(), 12u);
    for (std::size_t i = 0; i < placed.size(); ++i) {
      const Rect& box = placed[i].box;
      EXPECT_TRUE(box.x >= area_.x && box.y >= area_.y && box.right() <= area_.right() &&
                  box.bottom() <= area_.bottom());
      EXPECT_FALSE(box.Overlaps(title_));
      for (std::size_t k = 0; k < i; ++k) EXPECT_FALSE(box.Overlaps(placed[k].box));
    }
  }
}

TEST_F(LabelsTest, ALeaderEndsWhereTheThingIsSeen) {
  const physics::Scene scene = DemoScene();
  const Picture picture = DemoPicture(scene);
  const DrawList list = MakeDrawList(picture);
  const View view = MakeView(picture.camera, picture.width_px, picture.height_px, 0, list.bounds);
  const auto anchor_of_milk = [&](const std::vector<std::uint32_t>& seen) {
    Overlay overlay;
    AddTitleAndLabels(picture, list, view, seen, *font_, &overlay);
    for (const PlacedLabel& label : overlay.labels)
      if (label.request.text == "milk") return label.request.anchor;
    return Eigen::Vector2f(-1, -1);
  };
  const auto milk = static_cast<std::uint32_t>(list.first_body + 1);
  const Eigen::Vector2f middle = *ToPixel(view, list.objects[milk].bounds.center_m());
  EXPECT_EQ(anchor_of_milk({}), middle);
  // Something hides all of it but a strip of 20 pixels, 30 pixels to the right.
  std::vector<std::uint32_t> seen(std::size_t(1) * picture.width_px * picture.height_px, 1);
  const int left = static_cast<int>(middle.x()) + 30, top = static_cast<int>(middle.y()) - 10;
  for (int y = top; y < top + 20; ++y)
    for (int x = left; x < left + 20; ++x)
      seen[static_cast<std::size_t>(y) * picture.width_px + x] = milk;
  const Eigen::Vector2f anchor = anchor_of_milk(seen);
  EXPECT_GE(anchor.x(), left + 3) << "not at its edge";
  EXPECT_LT(anchor.x(), left + 5);
  EXPECT_NEAR(anchor.y(), middle.y(), 1);
}

TEST_F(LabelsTest, ManyLabelsInOnePlaceAreLeftOutRatherThanStacked) {
  const std::vector<LabelRequest> requests(300, {"same place", Hex(0), {400, 250}, {}});
  const std::vector<PlacedLabel> placed = Place(requests);
  EXPECT_GT(placed.size(), 2u);
  EXPECT_LT(placed.size(), 300u);
}

TEST_F(LabelsTest, KeepsOffItsThingAndOffPaths) {
  const Rect thing = {370, 220, 60, 60};
  for (int i = 0; i < 80; ++i) avoid_.emplace_back(400 + i, 200);
  const std::vector<PlacedLabel> placed = Place({{"thing", Hex(0), {400, 250}, thing}});
  ASSERT_EQ(placed.size(), 1u);
  EXPECT_FALSE(placed[0].box.Overlaps(thing.Grown(-4)));
  for (const auto& p : avoid_) EXPECT_FALSE(placed[0].box.Overlaps({p.x(), p.y(), 1, 1}));
}

TEST_F(LabelsTest, WithoutAPlaceOnThePictureThereIsNoLabel) {
  EXPECT_TRUE(Place({{"outside", Hex(0), {-50, 100}, {}}}).empty());
  EXPECT_TRUE(Place({{"nowhere", Hex(0), {std::nanf(""), 100}, {}}}).empty());
  EXPECT_TRUE(Place({{"", Hex(0), {100, 100}, {}}}).empty());
  EXPECT_TRUE(Place({{std::string(500, 'w'), Hex(0), {100, 100}, {}}}).empty());
}

}  // namespace
}  // namespace prehend::render
