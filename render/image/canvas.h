// SPDX-License-Identifier: Apache-2.0
// Anti-aliased drawing on an image: rounded rectangles, lines, text. Coordinates are pixels, y
// down. Drawing is clipped to the image. Labels need no more than this, so there is no dependency
// on cairo. Tested by tests/render/image/canvas_test.cc
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "render/image/image.h"

namespace prehend::render {

// A TrueType font: text widths and anti-aliased glyphs. Text is UTF-8; missing characters are drawn
// as the font's empty box.

struct Glyph {
  int left_px = 0, top_px = 0;  ///< from the pen on the baseline to the bitmap's corner, y down
  int width_px = 0, height_px = 0;
  std::vector<std::uint8_t> coverage;  ///< rows from top, 0..255
};

class Font {
 public:
  /// Null, with the reason in *error, if the file is missing or is not a font.
  static std::unique_ptr<Font> Read(const std::string& file, std::string* error);
  ~Font();

  float Width(std::string_view text, float size_px) const;
  float Advance(char32_t character, float size_px) const;
  float Ascent(float size_px) const;
  /// `fraction` is the pen's x inside its pixel, 0..1.
  Glyph Draw(char32_t character, float size_px, float fraction) const;
  /// The text, or its beginning with an ellipsis and its last `end` bytes, or nothing: at most
  /// this wide.
  std::string Shortened(const std::string& text, float size_px, float width_px,
                        std::size_t end = 0) const;

 private:
  struct State;
  explicit Font(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Code points of UTF-8 text; invalid bytes become U+FFFD.
std::vector<char32_t> CodePoints(std::string_view text);

struct Rect {
  float x = 0, y = 0, width = 0, height = 0;

  float right() const { return x + width; }
  float bottom() const { return y + height; }
  bool Overlaps(const Rect& other) const;
  Rect Grown(float margin) const {
    return {x - margin, y - margin, width + 2 * margin, height + 2 * margin};
  }
};

/// Converts 0xRRGGBB to a colour.
Color Hex(unsigned rgb);
/// White, a dark grey or black: the first with a contrast of 4.5 to the colour.
Color TextColorOn(const Color& background);

class Canvas {
 public:
  /// Draws on *image with this font; both must outlive the canvas.
  Canvas(const Font& font, Image* image) : font_(font), image_(*image) {}

  const Font& font() const { return font_; }
  void FillRounded(const Rect& rect, float radius, const Color& color, float alpha = 1);
  void DrawLine(Eigen::Vector2f from, Eigen::Vector2f to, float width, const Color& color,
                float alpha = 1);
  /// `top` is the y of the line's top; the baseline is rounded to a whole pixel.
  void DrawText(float left, float top, const std::string& text, float size_px, const Color& color);

 private:
  struct Span {
    int begin, end;
  };
  static Span Clip(float low, float high, int limit);
  void Blend(int x, int y, const Color& color, float alpha);

  const Font& font_;
  Image& image_;
};

}  // namespace prehend::render
