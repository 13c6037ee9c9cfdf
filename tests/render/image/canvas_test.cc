// SPDX-License-Identifier: Apache-2.0
#include "render/image/canvas.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/picture.h"

namespace prehend::render {
namespace {

class CanvasTest : public testing::Test {
 protected:
  CanvasTest()
      : font_(Font::Read(kDefaultFontFile, &error_)),
        image_{60, 40, std::vector<std::uint8_t>(60 * 40 * 3, 255)} {}
  void SetUp() override { ASSERT_NE(font_, nullptr) << error_; }

  int DarkPixels() const {
    int count = 0;
    for (std::size_t i = 0; i < image_.rgb.size(); i += 3) count += image_.rgb[i] < 128 ? 1 : 0;
    return count;
  }

  std::string error_;
  std::unique_ptr<Font> font_;
  Image image_;
};

TEST_F(CanvasTest, SharpRectangleCoversExactlyItsPixels) {
  Canvas(*font_, &image_).FillRounded({10, 5, 20, 12}, 0, Hex(0x000000));
  EXPECT_EQ(DarkPixels(), 20 * 12);
}

TEST_F(CanvasTest, RoundCornersTakeTheirArea) {
  Canvas(*font_, &image_).FillRounded({10, 5, 30, 30}, 15, Hex(0x000000));
  EXPECT_NEAR(DarkPixels(), M_PI * 15 * 15, 12);
}

TEST_F(CanvasTest, TextHasAContrastOfFourAndAHalfOnEveryColor) {
  const auto linear = [](float c) {
    return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
  };
  const auto luminance = [&](const Color& c) {
    return 0.2126f * linear(c.x()) + 0.7152f * linear(c.y()) + 0.0722f * linear(c.z()) + 0.05f;
  };
  for (unsigned rgb = 0; rgb < 0x1000000; rgb += 0x0F0D0B) {
    const float a = luminance(Hex(rgb)), b = luminance(TextColorOn(Hex(rgb)));
    EXPECT_GE(std::max(a, b) / std::min(a, b), 4.5f) << std::hex << rgb;
  }
}

TEST_F(CanvasTest, LineHasItsWidth) {
  Canvas(*font_, &image_).DrawLine({10, 20}, {50, 20}, 4, Hex(0x000000));
  EXPECT_NEAR(DarkPixels(), 40 * 4 + M_PI * 4, 6);
}

TEST_F(CanvasTest, WhatLiesOutsideIsClipped) {
  Canvas canvas(*font_, &image_);
  const float nan = std::nanf(""), huge = 1e30f;
  canvas.FillRounded({-100, -100, 50, 50}, 3, Hex(0));
  canvas.FillRounded({nan, 0, 10, 10}, 3, Hex(0));
  canvas.FillRounded({0, 0, -5, nan}, 3, Hex(0));
  canvas.DrawLine({nan, 0}, {5, 5}, 2, Hex(0));
  canvas.DrawLine({-9, -9}, {-50, -9}, 2, Hex(0));
  canvas.DrawText(1000, 1000, "far away", 14, Hex(0));
  EXPECT_EQ(DarkPixels(), 0);
  canvas.FillRounded({-huge, -huge, 2 * huge, 2 * huge}, 0, Hex(0));
  EXPECT_EQ(DarkPixels(), 60 * 40);
}

TEST_F(CanvasTest, TextIsAsWideAsMeasured) {
  Canvas(*font_, &image_).DrawText(5, 10, "HHH", 16, Hex(0));
  EXPECT_GT(DarkPixels(), 30);
  const auto edge = static_cast<int>(5 + font_->Width("HHH", 16));
  for (int y = 0; y < 40; ++y) {
    for (int x = edge + 1; x < 60; ++x) EXPECT_EQ(image_.rgb[(y * 60 + x) * 3], 255);
  }
}

TEST_F(CanvasTest, ShortenedFitsAndIsValidText) {
  const std::string text = "Gr\u00fc\u00dfe an alle";
  EXPECT_EQ(font_->Shortened(text, 14, 1000), text);
  for (float width = 0; width < 110; width += 3) {
    const std::string cut = font_->Shortened(text, 14, width);
    EXPECT_LE(font_->Width(cut, 14), width);
    for (const char32_t point : CodePoints(cut)) EXPECT_NE(point, 0xFFFDu) << cut;
    const std::string with_end = font_->Shortened(text, 14, width, 5);
    EXPECT_LE(font_->Width(with_end, 14), width);
    EXPECT_TRUE(width < 80 || with_end.ends_with(" alle")) << with_end;
  }
}

TEST(FontTest, MissingOrBrokenFileIsAnError) {
  std::string error;
  EXPECT_EQ(Font::Read("/no/such/font.ttf", &error), nullptr);
  EXPECT_NE(error.find("/no/such/font.ttf"), std::string::npos);
  error.clear();
  EXPECT_EQ(Font::Read(PREHEND_SOURCE_DIR "/LICENSE", &error), nullptr);
  EXPECT_FALSE(error.empty());
}

TEST(CodePointsTest, DecodesAndReplacesBrokenBytes) {
  using Points = std::vector<char32_t>;
  EXPECT_EQ(CodePoints("a\u00fc\u20ac\U0001F600"), (Points{'a', 0xFC, 0x20AC, 0x1F600}));
  EXPECT_EQ(CodePoints("\xFFz"), (Points{0xFFFD, 'z'}));
  EXPECT_EQ(CodePoints("\xE2\x82"), (Points{0xFFFD}));
  EXPECT_EQ(CodePoints("\xC3z"), (Points{0xFFFD, 'z'}));
}

TEST(TextColorTest, IsReadable) {
  EXPECT_EQ(TextColorOn(Hex(0xF1C40F)), Hex(0x1B1F24));
  EXPECT_EQ(TextColorOn(Hex(0x2A5CD6)), Hex(0xFFFFFF));
}

}  // namespace
}  // namespace prehend::render
