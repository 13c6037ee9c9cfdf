// SPDX-License-Identifier: Apache-2.0
// Shapes are drawn by their signed distance: anti-aliasing spans half a pixel on either side of the
// edge.
// Tested by tests/render/image/canvas_test.cc
// Fonts, by stb_truetype.
// Tested by tests/render/image/canvas_test.cc
#include "render/image/canvas.h"

#include <stb/stb_truetype.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "physics/base/check.h"

namespace prehend::render {

using Eigen::Vector2f;

struct Font::State {
  std::vector<std::uint8_t> bytes;
  stbtt_fontinfo info = {};
};

Font::Font(std::unique_ptr<State> state) : state_(std::move(state)) {}
Font::~Font() = default;

std::unique_ptr<Font> Font::Read(const std::string& file, std::string* error) {
  auto state = std::make_unique<State>();
  std::ifstream stream(file, std::ios::binary);
  state->bytes.assign(std::istreambuf_iterator<char>(stream), {});
  // stb_truetype trusts its input: the magic number and a plausible size are checked here.
  constexpr std::size_t kMinFont_bytes = 1024;
  const bool readable = state->bytes.size() >= kMinFont_bytes;
  const int offset = readable ? stbtt_GetFontOffsetForIndex(state->bytes.data(), 0) : -1;
  if (offset < 0 || stbtt_InitFont(&state->info, state->bytes.data(), offset) == 0) {
    *error = "cannot read the font " + file + " (Debian package fonts-dejavu-core)";
    return nullptr;
  }
  return std::unique_ptr<Font>(new Font(std::move(state)));
}

float Font::Advance(char32_t character, float size_px) const {
  int advance = 0, left = 0;
  stbtt_GetCodepointHMetrics(&state_->info, static_cast<int>(character), &advance, &left);
  return static_cast<float>(advance) * stbtt_ScaleForPixelHeight(&state_->info, size_px);
}

float Font::Width(std::string_view text, float size_px) const {
  float width = 0;
  for (const char32_t character : CodePoints(text)) width += Advance(character, size_px);
  return width;
}

float Font::Ascent(float size_px) const {
  int ascent = 0, descent = 0, gap = 0;
  stbtt_GetFontVMetrics(&state_->info, &ascent, &descent, &gap);
  return static_cast<float>(ascent) * stbtt_ScaleForPixelHeight(&state_->info, size_px);
}

Glyph Font::Draw(char32_t character, float size_px, float fraction) const {
  const float scale = stbtt_ScaleForPixelHeight(&state_->info, size_px);
  Glyph glyph;
  std::uint8_t* bitmap = stbtt_GetCodepointBitmapSubpixel(
      &state_->info, scale, scale, fraction, 0, static_cast<int>(character), &glyph.width_px,
      &glyph.height_px, &glyph.left_px, &glyph.top_px);
  if (bitmap == nullptr) return {};
  glyph.coverage.assign(bitmap, bitmap + glyph.width_px * glyph.height_px);
  stbtt_FreeBitmap(bitmap, nullptr);
  return glyph;
}

std::string Font::Shortened(const std::string& text, float size_px, float width_px,
                            std::size_t end) const {
  if (Width(text, size_px) <= width_px) return text;
  const auto is_inside_character = [&](std::size_t at) {
    return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80;
  };
  std::size_t tail = text.size() - std::min(end, text.size());
  while (is_inside_character(tail)) ++tail;
  for (std::size_t length = tail; length-- > 2;) {
    const std::string shorter = text.substr(0, length) + "\u2026" + text.substr(tail);
    if (!is_inside_character(length) && Width(shorter, size_px) <= width_px) return shorter;
  }
  return end > 0 ? Shortened(text, size_px, width_px) : "";
}

std::vector<char32_t> CodePoints(std::string_view text) {
  constexpr char32_t kReplacement = 0xFFFD;
  std::vector<char32_t> points;
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i++]);
    const int following = first < 0x80         ? 0
                          : (first >> 5) == 6  ? 1
                          : (first >> 4) == 14 ? 2
                          : (first >> 3) == 30 ? 3
                                               : -1;
    char32_t point = following <= 0 ? first : first & (0x3F >> following);
    int left = following;
    for (; left > 0 && i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0) == 0x80;
         --left, ++i) {
      point = point << 6 | (static_cast<unsigned char>(text[i]) & 0x3F);
    }
    points.push_back(left == 0 ? point : kReplacement);
  }
  return points;
}

bool Rect::Overlaps(const Rect& other) const {
  return x < other.right() && other.x < right() && y < other.bottom() && other.y < bottom();
}

Color Hex(unsigned rgb) {
  return Color(static_cast<float>(rgb >> 16 & 255), static_cast<float>(rgb >> 8 & 255),
               static_cast<float>(rgb & 255)) /
         255;
}

Color TextColorOn(const Color& background) {
  // Contrast as WCAG 2 defines it. One of white and black always has at least 4.58.
  constexpr float kWanted = 4.5f;
  const auto linear = [](float c) {
    return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
  };
  const auto luminance = [&](const Color& c) {
    return Color(linear(c.x()), linear(c.y()), linear(c.z())).dot(Color(0.2126f, 0.7152f, 0.0722f));
  };
  const float ground = luminance(background) + 0.05f;
  if (1.05f / ground >= kWanted) return Hex(0xFFFFFF);
  const Color ink = Hex(0x1B1F24);
  return ground / (luminance(ink) + 0.05f) >= kWanted ? ink : Hex(0x000000);
}

Canvas::Span Canvas::Clip(float low, float high, int limit) {
  const auto bound = static_cast<float>(limit);
  // With this order of arguments NaN gives an empty span.
  const float begin = std::max(0.0f, std::min(bound, std::floor(low)));
  const float end = std::max(0.0f, std::min(bound, std::ceil(high)));
  return {static_cast<int>(begin), static_cast<int>(end)};
}

void Canvas::Blend(int x, int y, const Color& color, float alpha) {
  if (x < 0 || y < 0 || x >= image_.width_px || y >= image_.height_px) return;
  PREHEND_DCHECK(image_.rgb.size() ==
                 3 * static_cast<std::size_t>(image_.width_px) * image_.height_px);
  std::uint8_t* pixel = &image_.rgb[(static_cast<std::size_t>(y) * image_.width_px + x) * 3];
  for (int k = 0; k < 3; ++k) {
    const float before = pixel[k];
    const float after = std::clamp(before + (color[k] * 255 - before) * alpha, 0.0f, 255.0f);
    pixel[k] = static_cast<std::uint8_t>(after + 0.5f);
  }
}

void Canvas::FillRounded(const Rect& rect, float radius, const Color& color, float alpha) {
  if (!(rect.width > 0) || !(rect.height > 0)) return;
  const float r = std::min({radius, rect.width / 2, rect.height / 2});
  const Span rows = Clip(rect.y - 1, rect.bottom() + 1, image_.height_px);
  const Span columns = Clip(rect.x - 1, rect.right() + 1, image_.width_px);
  for (int j = rows.begin; j < rows.end; ++j) {
    for (int i = columns.begin; i < columns.end; ++i) {
      const float px = static_cast<float>(i) + 0.5f, py = static_cast<float>(j) + 0.5f;
      const float dx = std::max(rect.x + r - px, px - (rect.right() - r));
      const float dy = std::max(rect.y + r - py, py - (rect.bottom() - r));
      const float outside = Vector2f(std::max(dx, 0.0f), std::max(dy, 0.0f)).norm() +
                            std::min(std::max(dx, dy), 0.0f) - r;
      const float coverage = std::clamp(0.5f - outside, 0.0f, 1.0f);
      if (coverage > 0) Blend(i, j, color, alpha * coverage);
    }
  }
}

void Canvas::DrawLine(Vector2f from, Vector2f to, float width, const Color& color, float alpha) {
  const Vector2f along = to - from;
  const float squared_length = along.squaredNorm();
  if (!std::isfinite(squared_length) || squared_length < 1e-6f) return;
  const Vector2f low = from.cwiseMin(to).array() - width - 1,
                 high = from.cwiseMax(to).array() + width + 1;
  const Span rows = Clip(low.y(), high.y(), image_.height_px),
             columns = Clip(low.x(), high.x(), image_.width_px);
  for (int j = rows.begin; j < rows.end; ++j) {
    for (int i = columns.begin; i < columns.end; ++i) {
      const Vector2f q =
          Vector2f(static_cast<float>(i) + 0.5f, static_cast<float>(j) + 0.5f) - from;
      const float share = std::clamp(q.dot(along) / squared_length, 0.0f, 1.0f);
      const float coverage =
          std::clamp(0.5f - ((q - share * along).norm() - width / 2), 0.0f, 1.0f);
      if (coverage > 0) Blend(i, j, color, alpha * coverage);
    }
  }
}

void Canvas::DrawText(float left, float top, const std::string& text, float size_px,
                      const Color& color) {
  const int baseline = static_cast<int>(std::lround(top + font_.Ascent(size_px)));
  float pen = left;
  for (const char32_t character : CodePoints(text)) {
    const int x = static_cast<int>(std::floor(pen));
    const Glyph glyph = font_.Draw(character, size_px, pen - std::floor(pen));
    for (int j = 0; j < glyph.height_px; ++j) {
      for (int i = 0; i < glyph.width_px; ++i) {
        const std::uint8_t coverage =
            glyph.coverage[static_cast<std::size_t>(j) * glyph.width_px + i];
        if (coverage > 0) {
          Blend(x + glyph.left_px + i, baseline + glyph.top_px + j, color,
                static_cast<float>(coverage) / 255);
        }
      }
    }
    pen += font_.Advance(character, size_px);
  }
}

}  // namespace prehend::render
