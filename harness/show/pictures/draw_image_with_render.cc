// SPDX-License-Identifier: Apache-2.0
// See harness/show/pictures/compose_picture.h. Tested by
// tests/harness/show/pictures/scene_painter_test.cc
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "harness/show/pictures/compose_picture.h"

namespace prehend::show {
namespace {

/// What lets white paper through more than black one is transparent. Colours are those that give
/// both pictures (Smith and Blinn, "Blue screen matting", 1996).
render::Image Matte(const render::Image& on_white, const render::Image& on_black) {
  render::Image image = on_black;
  image.alpha.resize(image.rgb.size() / 3);
  for (std::size_t i = 0; i < image.alpha.size(); ++i) {
    int through = 0;
    for (std::size_t k = 3 * i; k < 3 * i + 3; ++k)
      through += std::max(0, on_white.rgb[k] - on_black.rgb[k]);
    const int alpha = 255 - (through + 1) / 3;
    image.alpha[i] = static_cast<std::uint8_t>(alpha);
    for (std::size_t k = 3 * i; k < 3 * i + 3 && alpha > 0; ++k)
      image.rgb[k] = static_cast<std::uint8_t>(
          std::clamp<long>(std::lround(255.0 * on_black.rgb[k] / alpha), 0, 255));
  }
  return image;
}

}  // namespace

render::Image DrawImage(render::Painter& painter, const render::Picture& picture,
                        const PictureFormat& format) {
  if (!format.transparent) return painter.Draw(picture);
  render::Picture on_paper = picture;
  on_paper.theme = render::Theme::kPrint;
  const render::Image on_white = painter.Draw(on_paper);
  on_paper.paper = render::Color::Zero();
  const render::Image on_black = painter.Draw(on_paper);
  if (on_white.rgb.empty() || on_black.rgb.empty()) return {};
  return Matte(on_white, on_black);
}

render::Image PaleWithRed(const render::Image& first, const render::Image& second) {
  render::Image image = first;
  for (std::size_t i = 0; i < first.rgb.size(); i += 3) {
    const bool differs = render::PixelDiffers(first, second, i);
    const int grey = (first.rgb[i] + first.rgb[i + 1] + first.rgb[i + 2]) / 3;
    const auto pale = static_cast<std::uint8_t>(160 + grey * 3 / 8);
    image.rgb[i] = differs ? 220 : pale;
    image.rgb[i + 1] = image.rgb[i + 2] = differs ? 20 : pale;
  }
  return image;
}

}  // namespace prehend::show
