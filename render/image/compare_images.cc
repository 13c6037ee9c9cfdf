// SPDX-License-Identifier: Apache-2.0
// Tested by tests/render/image/compare_images_test.cc

#include <algorithm>
#include <cstdlib>

#include "physics/base/check.h"
#include "render/image/image.h"

namespace prehend::render {

bool PixelDiffers(const Image& golden, const Image& drawn, std::size_t i) {
  PREHEND_DCHECK(i + 2 < golden.rgb.size() && i + 2 < drawn.rgb.size());
  for (std::size_t k = i; k < i + 3; ++k) {
    if (std::abs(int{golden.rgb[k]} - int{drawn.rgb[k]}) > kMaxColorDifference) return true;
  }
  return false;
}

ImageDifference CompareImages(const Image& golden, const Image& drawn) {
  ImageDifference difference{.same_size = golden.width_px == drawn.width_px &&
                                          golden.height_px == drawn.height_px &&
                                          golden.rgb.size() == drawn.rgb.size()};
  if (!difference.same_size || golden.rgb == drawn.rgb) return difference;
  difference.left = golden.width_px;
  difference.top = golden.height_px;
  for (std::size_t i = 0; i + 2 < golden.rgb.size(); i += 3) {
    if (!PixelDiffers(golden, drawn, i)) continue;
    const int pixel = static_cast<int>(i / 3);
    const int x = pixel % golden.width_px, y = pixel / golden.width_px;
    difference.left = std::min(difference.left, x);
    difference.right = std::max(difference.right, x + 1);
    difference.top = std::min(difference.top, y);
    difference.bottom = std::max(difference.bottom, y + 1);
    ++difference.pixels;
  }
  return difference;
}

}  // namespace prehend::render
