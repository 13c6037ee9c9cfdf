// SPDX-License-Identifier: Apache-2.0
// Tables of 64-bit words (the bits of doubles, or integers) as few bytes, without loss, and with a
// hash of the words: whatever comes back is what was packed. How: docs/episodes.md. Nothing here
// knows what the words mean. Tested by tests/harness/episode/frames/columns_test.cc
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

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

}  // namespace prehend::episode
