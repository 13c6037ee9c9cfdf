// SPDX-License-Identifier: Apache-2.0
// A TrueType font: text widths and anti-aliased glyphs. Text is UTF-8; missing characters are drawn
// as the font's empty box.
// Tested by tests/render/image/canvas_test.cc
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace prehend::render {

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
  /// The text, or its beginning with an ellipsis, or nothing: at most this wide.
  std::string Shortened(const std::string& text, float size_px, float width_px) const;

 private:
  struct State;
  explicit Font(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Code points of UTF-8 text; invalid bytes become U+FFFD.
std::vector<char32_t> CodePoints(std::string_view text);

}  // namespace prehend::render
