// SPDX-License-Identifier: Apache-2.0
// Fonts, by stb_truetype.
// Tested by tests/render/image/canvas_test.cc
#include "render/image/font.h"

#include <stb/stb_truetype.h>

#include <fstream>
#include <iterator>

namespace prehend::render {

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

std::string Font::Shortened(const std::string& text, float size_px, float width_px) const {
  if (Width(text, size_px) <= width_px) return text;
  for (std::size_t length = text.size(); length-- > 0;) {
    const bool inside_character = (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80;
    const std::string beginning = text.substr(0, length) + "\u2026";
    if (!inside_character && length > 1 && Width(beginning, size_px) <= width_px) return beginning;
  }
  return "";
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

}  // namespace prehend::render
