// SPDX-License-Identifier: Apache-2.0
// The gate of golden pictures as a whole: which faults it must catch and name, and what it must let
// pass.
#include "render/inventory.h"

#include <gtest/gtest.h>

#include "tests/render/demo_picture.h"

namespace prehend::render {
namespace {

using testing::Test;

class InventoryTest : public Test {
 protected:
  static void SetUpTestSuite() { painter_ = new Painter; }
  static void TearDownTestSuite() { delete painter_; }
  void SetUp() override {
    ASSERT_EQ(painter_->error(), "");
    picture_ = DemoPicture(scene_);
    picture_.width_px = 960;
    picture_.height_px = 540;
    golden_ = painter_->DrawListed(picture_);
    ASSERT_FALSE(golden_.image.rgb.empty());
  }

  /// What tells the picture as it is now from the golden.
  std::vector<std::string> Told() {
    return TellApart(
        golden_.inventory, [&] { return golden_.image; }, painter_->DrawListed(picture_));
  }
  std::string FirstTold() {
    const std::vector<std::string> told = Told();
    return told.empty() ? "nothing" : told.front();
  }
  const ListedThing& Thing(const std::string& name) {
    for (const ListedThing& thing : golden_.inventory.list)
      if (thing.name == name) return thing;
    ADD_FAILURE() << name << "\n" << InventoryText(golden_.inventory);
    return golden_.inventory.list.front();
  }

  static Painter* painter_;
  physics::Scene scene_ = DemoScene();
  Picture picture_;
  ListedPicture golden_;
};
Painter* InventoryTest::painter_ = nullptr;

TEST_F(InventoryTest, EveryKindOfThingIsListedWithItsLook) {
  EXPECT_EQ(Thing("path:transporting").look,
            "#17a6ab, (0.190, 0.030, 1.030) to (-0.330, 0.020, 1.060) m");
  EXPECT_EQ(Thing("label:milk").look, "milk");
  EXPECT_EQ(Thing("title").look, "milk_carton_wrap: picking_up begins");
  EXPECT_EQ(Thing("bar:right_hand:sliding").look, "3.740..4.360 s #8f45ad");
  EXPECT_EQ(Thing("ghost:right_hand:2").look.substr(7), " 40 %");
  EXPECT_GT(Thing("mark:support").pixels, 20u);
  EXPECT_EQ(Thing("mark:region").pixels, 0u) << "it would hide what is in it";
  std::size_t pixels = 0;
  for (const ListedThing& thing : golden_.inventory.list) pixels += thing.pixels;
  EXPECT_EQ(pixels, 960u * 540) << "each pixel has one thing";
}

TEST_F(InventoryTest, TextIsReadAsItWasWritten) {
  const std::string text = InventoryText(golden_.inventory);
  const std::optional<Inventory> read = ReadInventory(text);
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(InventoryText(*read), text);
  EXPECT_TRUE(DescribeDifferences(golden_.inventory, *read).empty());
  EXPECT_FALSE(ReadInventory("").has_value());
  EXPECT_FALSE(ReadInventory(text.substr(0, 60)).has_value());
  EXPECT_FALSE(ReadInventory(text + "body:cup many\n").has_value());
}

TEST_F(InventoryTest, TheSamePictureIsTheSameAndItsImageIsNotRead) {
  const ListedPicture again = painter_->DrawListed(picture_);
  EXPECT_EQ(again.inventory.things, golden_.inventory.things);
  const auto read = [] {
    ADD_FAILURE() << "equal hashes need no image";
    return Image();
  };
  EXPECT_TRUE(TellApart(golden_.inventory, read, again).empty());
}

TEST_F(InventoryTest, APhaseColourOffByTwentyIsNamed) {
  picture_.path[3].color.x() += 20.0f / 255;
  EXPECT_EQ(FirstTold(), "path `transporting` changed colour, #17a6ab to #2ba6ab, " +
                             std::to_string(Thing("path:transporting").pixels) + " px");
  EXPECT_NE(Told().back().find(" of its pixels differ ("), std::string::npos);
}

TEST_F(InventoryTest, AChangedLabelIsNamed) {
  picture_.body_labels[1] = "milc";
  EXPECT_EQ(FirstTold(), "label `milk` says 'milc', expected 'milk'");
}

TEST_F(InventoryTest, ABoundaryMovedByTwentyMillisecondsIsNamed) {
  picture_.strip.rows[0].segments[5].end_s += 0.02;
  EXPECT_TRUE(
      FirstTold().starts_with("bar `sliding` of right_hand changed, 3.740..4.360 s #8f45ad "
                              "became 3.740..4.380 s #8f45ad, "))
      << FirstTold();
}

TEST_F(InventoryTest, APathEndMovedByTwoMillimetresIsNamed) {
  picture_.path[0].points_m.front().z() += 0.002f;
  EXPECT_EQ(FirstTold(),
            "path `reaching` changed, #db2626, (0.600, -0.580, 1.000) to (0.200, 0.020, "
            "0.900) m became #db2626, (0.600, -0.580, 1.002) to (0.200, 0.020, 0.900) "
            "m, " +
                std::to_string(Thing("path:reaching").pixels) + " px");
}

TEST_F(InventoryTest, AMissingThingIsNamed) {
  scene_.bodies[4].shapes.clear();
  EXPECT_TRUE(FirstTold().starts_with("thing `apple` is not seen, expected ")) << FirstTold();
  scene_ = DemoScene();
  scene_.bodies.pop_back();
  picture_.body_labels.pop_back();
  picture_.snapshot.bodies.pop_back();
  for (Ghost& ghost : picture_.ghosts) ghost.snapshot.bodies.pop_back();
  EXPECT_TRUE(FirstTold().starts_with("thing `can` is missing, expected ")) << FirstTold();
}

TEST_F(InventoryTest, AThingMovedByTwoCentimetresIsNamedAndColoursLittle) {
  picture_.snapshot.bodies[4].X_WB.p_m.x() += 0.02;
  EXPECT_TRUE(FirstTold().starts_with("thing `apple` is elsewhere, ")) << FirstTold();
  const ImageDifference difference = CompareImages(golden_.image, painter_->Draw(picture_));
  EXPECT_GT(difference.pixels, 0u);
  EXPECT_LT(difference.pixels, 960u * 540 / 20);
}

TEST_F(InventoryTest, WhatOnlyLooksDifferentIsNamedByItsPixels) {
  picture_.to_light = {-0.5f, -0.4f, 0.8f};
  EXPECT_NE(FirstTold().find(" looks different in "), std::string::npos) << FirstTold();
}

TEST_F(InventoryTest, AnotherProcessorPasses) {
  // Measured on five pictures with and without fused multiply-add: at most 0.2 % of the pixels, by
  // at most 7 of 255, and one pixel with another thing in front.
  ListedPicture other = golden_;
  for (std::size_t i = 0; i < other.image.rgb.size(); i += 600) other.image.rgb[i] ^= 7;
  other.inventory.pixels = PixelHash(other.image);
  ListedThing& table = other.inventory.list.at(2);
  table.pixels += 1;
  other.inventory.things ^= 1;
  other.inventory.drawn_by += " elsewhere";
  const auto read = [&] { return golden_.image; };
  EXPECT_TRUE(TellApart(golden_.inventory, read, other).empty());
  table.pixels += kMaxThingPixels;
  const std::vector<std::string> told = TellApart(golden_.inventory, read, other);
  ASSERT_EQ(told.size(), 2u);
  EXPECT_TRUE(told[0].starts_with("thing `table` shows ")) << told[0];
  EXPECT_TRUE(told[1].starts_with("the golden was drawn by ")) << told[1];
}

}  // namespace
}  // namespace prehend::render
