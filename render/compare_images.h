// SPDX-License-Identifier: Apache-2.0
// Whether two images show the same. Differences are counted, not averaged: a mean hides a small
// fault in a large picture. Tested by tests/render/compare_images_test.cc
#pragma once

#include "render/picture.h"

namespace prehend::render {

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
