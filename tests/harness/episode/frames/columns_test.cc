// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/frames/columns.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace prehend::episode {
namespace {

Word Bits(double value) { return std::bit_cast<Word>(value); }

/// Unpacks what was packed and expects every bit to be the same.
std::size_t ExpectRoundTrip(const std::vector<Columns>& tables) {
  TablePacker packer;
  const std::string packed = packer.Pack(tables);
  const std::vector<Columns> unpacked = packer.Unpack(packed);
  EXPECT_EQ(unpacked.size(), tables.size());
  for (std::size_t i = 0; i < std::min(unpacked.size(), tables.size()); ++i) {
    EXPECT_EQ(unpacked[i].rows, tables[i].rows);
    EXPECT_EQ(unpacked[i].width, tables[i].width);
    EXPECT_EQ(unpacked[i].words, tables[i].words);
  }
  return packed.size();
}

std::string WhyNot(const std::string& packed) {
  try {
    (void)TablePacker().Unpack(packed);
  } catch (const Damage& damage) {
    return damage.what();
  }
  return "";
}

Columns AnyBits(std::size_t rows) {
  std::mt19937_64 random(1);
  Columns columns(rows, 5);
  for (std::size_t row = 0; row < rows; ++row) {
    columns.At(row, 0) = random();
    columns.At(row, 1) = Bits(0.001 * static_cast<double>(row * row));
    columns.At(row, 2) = row % 7;
    columns.At(row, 3) = Bits(row % 2 ? 0.0 : -0.0);
    columns.At(row, 4) = Bits(row % 3 == 0   ? std::numeric_limits<double>::infinity()
                              : row % 3 == 1 ? -std::numeric_limits<double>::infinity()
                                             : std::nan(""));
  }
  return columns;
}

TEST(Columns, AnyBitsComeBack) {
  for (std::size_t rows = 0; rows < 40; ++rows) ExpectRoundTrip({AnyBits(rows)});
  ExpectRoundTrip({AnyBits(100), Columns(5, 0), Columns(0, 2), AnyBits(3)});
  ExpectRoundTrip({});
}

TEST(Columns, WhatStandsStillAndWhatMovesEvenlyIsShort) {
  Columns columns(400, 2);
  for (std::size_t row = 0; row < columns.rows; ++row) {
    columns.At(row, 0) = Bits(0.7);
    columns.At(row, 1) = Bits(1 + static_cast<double>(row) / 256);
  }
  EXPECT_LT(ExpectRoundTrip({columns}), 120u) << "of 6400";
}

TEST(Columns, AreAsTheFormatSays) {
  Columns columns(3, 2);
  constexpr Word kLarge = Word{1} << 40;
  columns.words = {10, 11, 9, kLarge, kLarge + 1, kLarge};
  Compressor compressor;
  const std::string packed = TablePacker().Pack({&columns, 1});
  const auto bytes = compressor.Unpack(std::string_view(packed).substr(8), 100);
  using namespace std::string_literals;
  EXPECT_EQ(bytes,
            "\3\0\0\0\0\0\0\0\2\0\0\0\0\0\0\0"
            "\0\1\24\26\22"
            "\1\1\0\0\0\0\0\1\0\0\2\1"s);
}

TEST(Columns, OtherWordsThanThoseThatWerePackedAreRefused) {
  const Columns columns = AnyBits(50);
  std::string packed = TablePacker().Pack({&columns, 1});
  packed[3] ^= 1;
  EXPECT_EQ(WhyNot(packed), "this program decodes a part otherwise than the one that wrote it");
}

TEST(Columns, AnyDamageIsRefused) {
  const Columns columns = AnyBits(50);
  const std::string good = TablePacker().Pack({&columns, 1});
  const std::string bytes(*Compressor().Unpack(std::string_view(good).substr(8), 1 << 20));
  std::mt19937 random(3);
  const auto packed = [&](const std::string& changed) {
    return good.substr(0, 8) + std::string(Compressor().Pack(changed));
  };
  EXPECT_EQ(packed(bytes), good);
  for (std::size_t size = 0; size < bytes.size(); size += 7)
    EXPECT_NE(WhyNot(packed(bytes.substr(0, size))), "") << size;
  for (int trial = 0; trial < 2000; ++trial) {
    std::string bad = bytes;
    const std::size_t at = random() % bad.size();
    bad[at] = static_cast<char>(bad[at] ^ (1 + random() % 255));
    EXPECT_NE(WhyNot(packed(bad)), "") << at;
  }
  for (const std::string& none : {std::string(), std::string("short"), good.substr(0, 20)})
    EXPECT_NE(WhyNot(none), "");
}

TEST(Compressor, RefusesWhatItDidNotPackAndWhatUnpacksToTooMuch) {
  Compressor compressor;
  const std::string packed(compressor.Pack(std::string(1000, 'a')));
  EXPECT_EQ(compressor.Unpack(packed, 1000), std::string(1000, 'a'));
  EXPECT_FALSE(compressor.Unpack(packed, 999));
  EXPECT_FALSE(compressor.Unpack("no zstd", 1000));
  EXPECT_FALSE(compressor.Unpack(std::string_view(packed).substr(0, packed.size() - 1), 1000));
}

}  // namespace
}  // namespace prehend::episode
