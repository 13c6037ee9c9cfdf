// SPDX-License-Identifier: Apache-2.0
// Tables of 64-bit words (the bits of doubles, or integers) as few bytes, without loss, and with a
// hash of the words: whatever comes back is what was packed. How: docs/episodes.md. Nothing here
// knows what the words mean. Tested by tests/harness/episode/frames/columns_test.cc
#pragma once

#include <Eigen/Geometry>
#include <bit>
#include <concepts>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "physics/base/ids.h"

namespace prehend::episode {

using Word = std::uint64_t;

/// A table, column after column.
struct Columns {
  std::size_t rows = 0;
  std::size_t width = 0;
  std::vector<Word> words;  ///< rows * width

  Columns() = default;
  Columns(std::size_t row_count, std::size_t column_count)
      : rows(row_count), width(column_count), words(row_count * column_count) {}
  Word& At(std::size_t row, std::size_t column) { return words[column * rows + row]; }
  Word At(std::size_t row, std::size_t column) const { return words[column * rows + row]; }
  std::span<Word> Column(std::size_t column) {
    return std::span(words).subspan(column * rows, rows);
  }
};

/// Rows, one after another, as a table.
Columns Transposed(const std::vector<Word>& rows, std::size_t width);

/// What an episode file says cannot be; the text says why not.
class Damage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// zstd, with its memory kept from call to call.
class Compressor {
 public:
  explicit Compressor(int level = 3);
  ~Compressor();
  Compressor(Compressor&&) noexcept;
  /// Valid until the next call.
  std::string_view Pack(std::string_view bytes);
  /// Valid until the next call. Nothing if the bytes are damaged or unpack to more than
  /// `most_bytes`.
  std::optional<std::string_view> Unpack(std::string_view packed, std::size_t most_bytes);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Tables <-> bytes.
class TablePacker {
 public:
  std::string Pack(std::span<const Columns> tables);
  /// Throws Damage; any bytes are safe.
  std::vector<Columns> Unpack(std::string_view packed);

 private:
  Compressor compressor_;
};

// The values of a row of a table. A function that hands them to its `cells` in their order fills
// the row with a CellWriter and reads it with a CellReader, so both directions are told once.
// Tested by tests/harness/episode/frames/frames_test.cc

/// Appends values to a row.
class CellWriter {
 public:
  explicit CellWriter(std::vector<Word>& row) : row_(row) {}
  template <typename... Values>
  void operator()(const Values&... values) {
    (Put(values), ...);
  }
  /// In one cell, where older files have the first alone.
  void Flags(bool first, bool second) { Put(first + 2 * second); }

 private:
  void Put(double value) { row_.push_back(std::bit_cast<Word>(value)); }
  void Put(std::integral auto value) {
    row_.push_back(static_cast<Word>(static_cast<std::int64_t>(value)));
  }
  template <typename Thing>
  void Put(physics::Index<Thing> index) {
    Put(index.number());
  }
  void Put(const Eigen::Vector3d& v) { (*this)(v[0], v[1], v[2]); }
  void Put(const Eigen::Quaterniond& q) { (*this)(q.x(), q.y(), q.z(), q.w()); }

  std::vector<Word>& row_;
};

/// Takes them from a row of a table. Integers are not checked.
class CellReader {
 public:
  CellReader(const Columns& columns, std::size_t row) : columns_(columns), row_(row) {}
  template <typename... Values>
  void operator()(Values&... values) {
    (Take(values), ...);
  }
  void Flags(bool& first, bool& second) {
    const Word flags = Next();
    first = (flags & 1) != 0;
    second = (flags & 2) != 0;
  }

 private:
  Word Next() { return columns_.At(row_, next_++); }
  void Take(double& value) { value = std::bit_cast<double>(Next()); }
  template <std::integral Integer>
  void Take(Integer& value) {
    value = static_cast<Integer>(static_cast<std::int64_t>(Next()));
  }
  template <typename Thing>
  void Take(physics::Index<Thing>& index) {
    index = physics::Index<Thing>(static_cast<std::int64_t>(Next()));
  }
  void Take(Eigen::Vector3d& v) { (*this)(v[0], v[1], v[2]); }
  void Take(Eigen::Quaterniond& q) { (*this)(q.x(), q.y(), q.z(), q.w()); }

  const Columns& columns_;
  std::size_t row_;
  std::size_t next_ = 0;
};

}  // namespace prehend::episode
