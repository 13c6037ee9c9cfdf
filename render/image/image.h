// SPDX-License-Identifier: Apache-2.0
// Images as values: PNG files, hashes, and how far two of them differ. Colours are sRGB, 0..1.
// Tested by tests/render/image/image_file_test.cc, tests/render/image/compare_images_test.cc
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace prehend::render {

using Color = Eigen::Vector3f;

inline constexpr int kMaxPictureSide_px = 8192;

struct Image {
  int width_px = 0, height_px = 0;
  std::vector<std::uint8_t> rgb = {};    ///< rows from top, 3 bytes a pixel
  std::vector<std::uint8_t> alpha = {};  ///< a byte a pixel, 255 is opaque; empty: all opaque
};

enum class PngKind {
  kExact,
  kSmall  ///< colours rounded to multiples of 4, which nobody sees: half as many bytes
};

/// The bytes of a PNG file; none of an image that is empty.
std::string EncodePng(const Image& image, PngKind kind = PngKind::kExact);
/// An empty image if the file is missing, damaged or larger than a picture may be.
Image ReadPng(const std::string& path);
/// The same of the bytes of a file.
Image DecodePng(const std::string& bytes);
/// A hash of size and pixels, in the manner of FNV-1a but of eight bytes at a time.
std::uint64_t PixelHash(const Image& image);

// Whether two images show the same. Differences are counted, not averaged: a mean hides a small
// fault in a large picture.

/// A pixel differs if some colour is farther apart than this, of 255. Processors with and without
/// fused multiply-add stay below it.
inline constexpr int kMaxColorDifference = 16;
/// More differing pixels than this are a difference.
inline constexpr std::size_t kMaxDifferingPixels = 20;

struct ImageDifference {
  bool same_size = false;
  std::size_t pixels = 0;                        ///< how many differ
  int left = 0, top = 0, right = 0, bottom = 0;  ///< the box around them, right and bottom excluded

  bool AreEqual() const { return same_size && pixels <= kMaxDifferingPixels; }
};

/// Images of different sizes are not compared further.
ImageDifference CompareImages(const Image& golden, const Image& drawn);

/// Whether the pixel whose red is byte `i` differs in two images of one size.
bool PixelDiffers(const Image& golden, const Image& drawn, std::size_t i);

}  // namespace prehend::render
