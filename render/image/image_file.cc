// SPDX-License-Identifier: Apache-2.0
// Reads and writes PNG files, and hashes images. For exact colours level 3 with the SUB filter is
// the fastest setting with small files; for rounded ones level 6 without a filter. Tested by
// tests/render/image/image_file_test.cc and tests/render/image/compare_images_test.cc
#include <png.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "physics/base/check.h"
#include "render/image/image.h"

namespace prehend::render {
namespace {

std::uint64_t HashBytes(std::uint64_t hash, const void* bytes, std::size_t size) {
  constexpr std::uint64_t kPrime = 0x100000001b3;
  const auto* const from = static_cast<const std::uint8_t*>(bytes);
  for (std::size_t i = 0; i < size; i += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, from + i, std::min(sizeof word, size - i));
    hash = (hash ^ word) * kPrime;
    hash ^= hash >> 29;  // the product alone carries nothing from high bits to low ones
  }
  return hash;
}

// The caller reports the failure; libpng's own messages are suppressed.
[[noreturn]] void FailSilently(png_structp png, png_const_charp) { png_longjmp(png, 1); }
void StaySilent(png_structp, png_const_charp) {}

void AppendBytes(png_structp png, png_bytep bytes, std::size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))
      ->append(reinterpret_cast<const char*>(bytes), size);
}
void FlushNothing(png_structp) {}

// libpng reports errors by longjmp: no object with a destructor may live between here and the jump.
bool WriteRows(png_structp png, png_infop info, const Image& image, PngKind kind, std::uint8_t* row,
               std::string* bytes) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  const bool has_alpha = !image.alpha.empty();
  png_set_write_fn(png, bytes, AppendBytes, FlushNothing);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width_px),
               static_cast<png_uint_32>(image.height_px), 8,
               has_alpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(png, kind == PngKind::kSmall ? 6 : 3);
  png_set_filter(png, 0, kind == PngKind::kSmall ? PNG_FILTER_NONE : PNG_FILTER_SUB);
  png_write_info(png, info);
  const auto width = static_cast<std::size_t>(image.width_px);
  for (int y = 0; y < image.height_px; ++y) {
    const std::uint8_t* rgb = image.rgb.data() + static_cast<std::size_t>(y) * width * 3;
    for (std::size_t x = 0; x < width && has_alpha; ++x) {
      std::copy_n(rgb + 3 * x, 3, row + 4 * x);
      row[4 * x + 3] = image.alpha[static_cast<std::size_t>(y) * width + x];
    }
    png_write_row(png, has_alpha ? row : rgb);
  }
  png_write_end(png, info);
  return true;
}

Image Rounded(Image image) {
  for (std::uint8_t& c : image.rgb) c = static_cast<std::uint8_t>(std::min(255, (c + 2) / 4 * 4));
  return image;
}

/// After png_image_begin_read_*.
Image FinishReading(png_image& header) {
  header.format = PNG_FORMAT_RGB;
  Image image{.width_px = static_cast<int>(header.width),
              .height_px = static_cast<int>(header.height)};
  if (image.width_px > kMaxPictureSide_px || image.height_px > kMaxPictureSide_px) {
    png_image_free(&header);
    return {};
  }
  image.rgb.resize(PNG_IMAGE_SIZE(header));
  const bool complete = png_image_finish_read(&header, nullptr, image.rgb.data(), 0, nullptr) != 0;
  return complete ? image : Image{};
}

}  // namespace

std::string EncodePng(const Image& exact, PngKind kind) {
  const Image image = kind == PngKind::kSmall ? Rounded(exact) : exact;
  const std::size_t pixels =
      image.width_px > 0 ? static_cast<std::size_t>(image.width_px) * image.height_px : 0;
  const bool is_whole = pixels > 0 && image.rgb.size() == 3 * pixels &&
                        (image.alpha.empty() || image.alpha.size() == pixels);
  if (!is_whole) return {};
  std::string bytes;
  std::vector<std::uint8_t> row(4ull * image.width_px);
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, FailSilently, StaySilent);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  const bool written = info != nullptr && WriteRows(png, info, image, kind, row.data(), &bytes);
  png_destroy_write_struct(&png, &info);
  return written ? bytes : std::string();
}

Image ReadPng(const std::string& path) {
  png_image header = {};
  header.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&header, path.c_str()) == 0) return {};
  return FinishReading(header);
}

Image DecodePng(const std::string& bytes) {
  png_image header = {};
  header.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()) == 0) return {};
  return FinishReading(header);
}

std::uint64_t PixelHash(const Image& image) {
  const std::int32_t size[] = {image.width_px, image.height_px};
  constexpr std::uint64_t kOffsetBasis = 0xcbf29ce484222325;
  return HashBytes(HashBytes(kOffsetBasis, size, sizeof size), image.rgb.data(), image.rgb.size());
}

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
