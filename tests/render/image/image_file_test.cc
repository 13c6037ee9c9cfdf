// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include "render/image/image.h"

namespace prehend::render {
namespace {

std::string TempFile(const std::string& name) {
  return testing::TempDir() + "prehend_image_file_test_" + name;
}

void WritePng(const Image& image, const std::string& file) {
  std::ofstream(file, std::ios::binary) << EncodePng(image);
}

Image Gradient(int width_px, int height_px) {
  Image image{width_px, height_px, {}};
  for (int i = 0; i < width_px * height_px * 3; ++i)
    image.rgb.push_back(static_cast<std::uint8_t>(i * 7 + i / 50));
  return image;
}

TEST(ImageFileTest, PngRoundTripKeepsEveryPixel) {
  const std::string file = TempFile("round_trip.png");
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 2}, {257, 31}}) {
    const Image image = Gradient(width, height);
    WritePng(image, file);
    const Image back = ReadPng(file);
    EXPECT_EQ(back.width_px, width);
    EXPECT_EQ(back.height_px, height);
    EXPECT_EQ(back.rgb, image.rgb);
    EXPECT_EQ(PixelHash(back), PixelHash(image));
  }
  std::remove(file.c_str());
}

TEST(ImageFileTest, WhatIsNoImageHasNoBytes) {
  EXPECT_EQ(EncodePng({}), "");
  EXPECT_EQ(EncodePng({.width_px = 5, .height_px = 5, .rgb = {1, 2, 3}}), "");
}

TEST(ImageFileTest, ReadingRubbishGivesNothing) {
  EXPECT_TRUE(ReadPng(TempFile("missing.png")).rgb.empty());
  const std::string file = TempFile("rubbish.png");
  std::ofstream(file) << "this is no picture";
  EXPECT_TRUE(ReadPng(file).rgb.empty());
  WritePng(Gradient(64, 64), file);
  std::ifstream whole(file, std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(whole), {});
  std::ofstream(file, std::ios::binary) << bytes.substr(0, bytes.size() / 2);
  EXPECT_TRUE(ReadPng(file).rgb.empty()) << "cut in half";
  std::remove(file.c_str());
}

TEST(PixelHashTest, SeesEveryByteAndTheShape) {
  const Image image = Gradient(4, 6);
  Image other = image;
  other.rgb.back() ^= 1;
  EXPECT_NE(PixelHash(image), PixelHash(other));
  other = image;
  std::swap(other.width_px, other.height_px);
  EXPECT_NE(PixelHash(image), PixelHash(other));
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    other = image;
    other.rgb[i] ^= 128;
    EXPECT_NE(PixelHash(image), PixelHash(other)) << "byte " << i;
  }
  // It stands in files: golden pictures would all have to be accepted again.
  EXPECT_EQ(PixelHash(Image{}), 0xaf63bd49fd1c5dbbu);
}

}  // namespace
}  // namespace prehend::render
