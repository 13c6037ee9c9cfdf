// SPDX-License-Identifier: Apache-2.0
// Columns of 64-bit words (the bits of doubles, or integers) as few bytes, without loss. Each word
// is guessed from those before it; what is kept is by how many representable numbers the guess is
// off. Bytes of equal weight stand together, so that a general compressor finds the zeros. The
// layout of the bytes: docs/episodes.md. Tested by tests/harness/episode/frames/columns_test.cc
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
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
  std::span<const Word> Column(std::size_t column) const {
    return std::span(words).subspan(column * rows, rows);
  }
};

/// Neighbouring doubles become neighbouring integers.
inline Word Ordered(Word word) { return word >> 63 ? ~word : word | Word{1} << 63; }
inline Word FromOrdered(Word word) { return word >> 63 ? word & ~(Word{1} << 63) : ~word; }

/// How many representable doubles lie between a word and its guess, small for both signs.
inline Word Distance(Word word, Word guess) {
  const Word difference = Ordered(word) - Ordered(guess);
  return (difference << 1) ^ (difference >> 63 ? ~Word{0} : Word{0});
}
/// The word again.
inline Word AtDistance(Word guess, Word distance) {
  const Word difference = (distance >> 1) ^ (distance & 1 ? ~Word{0} : Word{0});
  return FromOrdered(Ordered(guess) + difference);
}

/// What is known of the columns before they are decoded.
struct Guesses {
  /// Per row the earlier row that it continues, or -1. Empty: the row before it.
  std::vector<int> before = {};
  /// The first columns hold the motion of a rigid body: position (3), unit quaternion x y z w (4),
  /// velocity (3), angular velocity (3), a row per `dt_s`. 0: they do not.
  double dt_s = 0;
};

/// Appends the coded columns.
void Encode(const Columns& columns, const Guesses& guesses, std::string& bytes);

/// Takes coded columns off the front of `bytes`. Nothing if they are damaged; any bytes are safe.
std::optional<Columns> Decode(std::string_view& bytes, std::size_t rows, std::size_t width,
                              const Guesses& guesses);

/// Words from the planes of their bytes, plane after plane; `bytes` has `planes` (0 to 8) times as
/// many as there are words.
void JoinPlanes(const char* bytes, int planes, std::span<Word> words);
/// The other way round: the lowest `planes` bytes of each word.
void SplitPlanes(std::span<const Word> words, int planes, char* bytes);

/// Integers of any size, short ones in few bytes (LEB128).
void AppendVarint(Word value, std::string& bytes);
/// Takes one off the front of `bytes`.
std::optional<Word> TakeVarint(std::string_view& bytes);

/// zstd, with its memory kept from call to call.
class Compressor {
 public:
  explicit Compressor(int level = 1);
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

}  // namespace prehend::episode
