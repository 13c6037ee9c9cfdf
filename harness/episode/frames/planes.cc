// SPDX-License-Identifier: Apache-2.0
// See harness/episode/frames/columns.h. Tested by tests/harness/episode/frames/columns_test.cc
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "harness/episode/frames/columns.h"

namespace prehend::episode {
namespace {

/// The bytes of eight words, as a matrix with a word per row, change rows and columns.
void TransposeBytes(std::array<Word, 8>& m) {
  const auto swap = [](Word& upper, Word& lower, int bits, Word mask) {
    const Word change = ((upper >> bits) ^ lower) & mask;
    upper ^= change << bits;
    lower ^= change;
  };
  constexpr Word kHalves = 0x00000000ffffffff, kQuarters = 0x0000ffff0000ffff,
                 kBytes = 0x00ff00ff00ff00ff;
  swap(m[0], m[4], 32, kHalves);
  swap(m[1], m[5], 32, kHalves);
  swap(m[2], m[6], 32, kHalves);
  swap(m[3], m[7], 32, kHalves);
  swap(m[0], m[2], 16, kQuarters);
  swap(m[1], m[3], 16, kQuarters);
  swap(m[4], m[6], 16, kQuarters);
  swap(m[5], m[7], 16, kQuarters);
  swap(m[0], m[1], 8, kBytes);
  swap(m[2], m[3], 8, kBytes);
  swap(m[4], m[5], 8, kBytes);
  swap(m[6], m[7], 8, kBytes);
}

/// With few planes, one word after another is faster.
template <int planes>
constexpr bool kInEights = planes >= 4 && std::endian::native == std::endian::little;

/// Words from the planes of their bytes, plane after plane.
template <int planes>
void JoinPlanesOf(const char* bytes, std::span<Word> words) {
  const std::size_t count = words.size();
  std::size_t i = 0;
  for (; kInEights<planes> && i + 8 <= count; i += 8) {
    std::array<Word, 8> eight{};
    for (int plane = 0; plane < planes; ++plane)
      std::memcpy(&eight[static_cast<std::size_t>(plane)],
                  bytes + static_cast<std::size_t>(plane) * count + i, 8);
    TransposeBytes(eight);
    std::ranges::copy(eight, words.begin() + static_cast<std::ptrdiff_t>(i));
  }
  for (; i < count; ++i) {
    Word word = 0;
    for (int plane = 0; plane < planes; ++plane)
      word |= Word{static_cast<std::uint8_t>(bytes[static_cast<std::size_t>(plane) * count + i])}
              << (8 * plane);
    words[i] = word;
  }
}

template <int planes>
void SplitPlanesOf(std::span<const Word> words, char* bytes) {
  const std::size_t count = words.size();
  std::size_t i = 0;
  for (; kInEights<planes> && i + 8 <= count; i += 8) {
    std::array<Word, 8> eight{};
    std::copy_n(words.begin() + static_cast<std::ptrdiff_t>(i), 8, eight.begin());
    TransposeBytes(eight);
    for (int plane = 0; plane < planes; ++plane)
      std::memcpy(bytes + static_cast<std::size_t>(plane) * count + i,
                  &eight[static_cast<std::size_t>(plane)], 8);
  }
  for (; i < count; ++i) {
    for (int plane = 0; plane < planes; ++plane)
      bytes[static_cast<std::size_t>(plane) * count + i] =
          static_cast<char>(words[i] >> (8 * plane));
  }
}

}  // namespace

void JoinPlanes(const char* bytes, int planes, std::span<Word> words) {
  using Join = void (*)(const char*, std::span<Word>);
  constexpr Join kJoins[] = {JoinPlanesOf<0>, JoinPlanesOf<1>, JoinPlanesOf<2>,
                             JoinPlanesOf<3>, JoinPlanesOf<4>, JoinPlanesOf<5>,
                             JoinPlanesOf<6>, JoinPlanesOf<7>, JoinPlanesOf<8>};
  kJoins[planes](bytes, words);
}

void SplitPlanes(std::span<const Word> words, int planes, char* bytes) {
  using Split = void (*)(std::span<const Word>, char*);
  constexpr Split kSplits[] = {SplitPlanesOf<0>, SplitPlanesOf<1>, SplitPlanesOf<2>,
                               SplitPlanesOf<3>, SplitPlanesOf<4>, SplitPlanesOf<5>,
                               SplitPlanesOf<6>, SplitPlanesOf<7>, SplitPlanesOf<8>};
  kSplits[planes](words, bytes);
}

}  // namespace prehend::episode
