// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/frames/columns.h"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "harness/base/base/content_hash.h"

namespace prehend::episode {
namespace {

static_assert(std::endian::native == std::endian::little, "words are kept as they are in memory");

constexpr std::size_t kMostOrder = 3, kHashBytes = 8;
constexpr std::size_t kMostWordsOfPart = std::size_t{1} << 24,
                      kMostBytesOfPart = 9 * kMostWordsOfPart;

/// Small for small differences of both signs, and back.
Word Folded(Word difference) { return (difference << 1) ^ (Word{0} - (difference >> 63)); }
Word Unfolded(Word folded) { return (folded >> 1) ^ (Word{0} - (folded & 1)); }

/// Each word, from the second on, becomes its difference to the one before; and so often back.
void Differ(std::span<Word> words) {
  for (std::size_t i = words.size(); i-- > 1;) words[i] -= words[i - 1];
}
template <std::size_t kTimes>
void Sum(std::span<Word> words) {
  std::array<Word, kTimes> sums{};
  for (Word& word : words) {
    Word last = word;
    for (Word& sum : sums) last = sum += last;
    word = last;
  }
}

using Bytes [[gnu::vector_size(16)]] = std::uint8_t;
using Pairs [[gnu::vector_size(16)]] = std::uint16_t;
using Fours [[gnu::vector_size(16)]] = std::uint32_t;
using Words [[gnu::vector_size(16)]] = Word;

/// The bytes of eight words, as a matrix with a word per row, change rows and columns.
void TransposeBytes(std::array<Word, 8>& m) {
  Pairs pairs[4];
  for (std::size_t i = 0; i < 4; ++i) {
    const auto a = reinterpret_cast<Bytes>(Words{m[2 * i], 0}),
               b = reinterpret_cast<Bytes>(Words{m[2 * i + 1], 0});
    pairs[i] = reinterpret_cast<Pairs>(
        __builtin_shufflevector(a, b, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23));
  }
  Fours low[2], high[2];
  for (std::size_t i = 0; i < 2; ++i) {
    const Pairs a = pairs[2 * i], b = pairs[2 * i + 1];
    low[i] = reinterpret_cast<Fours>(__builtin_shufflevector(a, b, 0, 8, 1, 9, 2, 10, 3, 11));
    high[i] = reinterpret_cast<Fours>(__builtin_shufflevector(a, b, 4, 12, 5, 13, 6, 14, 7, 15));
  }
  const Fours turned[] = {__builtin_shufflevector(low[0], low[1], 0, 4, 1, 5),
                          __builtin_shufflevector(low[0], low[1], 2, 6, 3, 7),
                          __builtin_shufflevector(high[0], high[1], 0, 4, 1, 5),
                          __builtin_shufflevector(high[0], high[1], 2, 6, 3, 7)};
  std::memcpy(m.data(), turned, sizeof turned);
}

/// Calls `move` for eight words, or the last fewer ones, at a time.
template <typename Move>
void InEights(std::size_t count, const Move& move) {
  std::size_t i = 0;
  for (; i + 8 <= count; i += 8) move(i, std::integral_constant<std::size_t, 8>());
  if (i < count) move(i, count - i);
}

void AppendWord(Word word, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(&word), sizeof(word));
}

Word TakeWord(std::string_view& bytes) {
  Word word = 0;
  if (bytes.size() < sizeof(word)) throw Damage("a part is too short");
  std::memcpy(&word, bytes.data(), sizeof(word));
  bytes.remove_prefix(sizeof(word));
  return word;
}

/// A column: how often differences were taken, so many planes, what begins the sums, the planes.
void AppendColumn(std::span<const Word> column, std::string& bytes) {
  std::vector<Word> now(column.begin(), column.end()), best;
  std::size_t order = 0;
  Word least_bits = ~Word{0};
  for (std::size_t i = 0; i <= std::min(kMostOrder, column.size()); ++i) {
    if (i > 0) Differ(now);
    Word bits = 64 * i;
    for (std::size_t row = i; row < now.size(); ++row)
      bits += static_cast<Word>(std::bit_width(Folded(now[row])));
    if (bits >= least_bits) continue;
    least_bits = bits;
    order = i;
    best = now;
  }
  Word all = 0;
  for (std::size_t row = order; row < best.size(); ++row) all |= best[row] = Folded(best[row]);
  const auto planes = static_cast<std::size_t>(std::bit_width(all) + 7) / 8;
  bytes += static_cast<char>(order);
  bytes += static_cast<char>(planes);
  for (std::size_t row = 0; row < order; ++row) AppendWord(best[row], bytes);
  const std::size_t count = best.size() - order, begin = bytes.size();
  bytes.resize(begin + planes * count);
  InEights(count, [&](std::size_t i, auto few) {
    std::array<Word, 8> eight{};
    std::memcpy(eight.data(), &best[order + i], few * sizeof(Word));
    TransposeBytes(eight);
    for (std::size_t plane = 0; plane < planes; ++plane)
      std::memcpy(&bytes[begin + plane * count + i], &eight[plane], few);
  });
}

void TakeColumn(std::string_view& bytes, std::span<Word> column) {
  if (bytes.size() < 2) throw Damage("a part is too short");
  const auto order = static_cast<std::uint8_t>(bytes[0]);
  const auto planes = static_cast<std::uint8_t>(bytes[1]);
  bytes.remove_prefix(2);
  if (order > std::min(kMostOrder, column.size()) || planes > 8)
    throw Damage("a part has a column of no known kind");
  for (std::size_t row = 0; row < order; ++row) column[row] = TakeWord(bytes);
  const std::size_t count = column.size() - order;
  if (bytes.size() < planes * count) throw Damage("a part is too short");
  const std::span<Word> rest = column.subspan(order);  // zeros
  const auto take = [&](std::size_t i, auto few) {
    std::array<Word, 8> eight{};
    for (std::size_t plane = 0; plane < planes; ++plane)
      std::memcpy(&eight[plane], bytes.data() + plane * count + i, few);
    TransposeBytes(eight);
    for (Word& word : eight) word = Unfolded(word);
    std::memcpy(&rest[i], eight.data(), few * sizeof(Word));
  };
  if (planes > 0) InEights(count, take);
  bytes.remove_prefix(planes * count);
  if (order == 1) Sum<1>(column);
  if (order == 2) Sum<2>(column);
  if (order == 3) Sum<3>(column);
}

/// Of one table after another; each has the hash of those before as its place.
Word HashOf(std::span<const Columns> tables) {
  Word hash = 0;
  for (const Columns& table : tables) {
    const auto* begin = reinterpret_cast<const char*>(table.words.data());
    hash = ContentHashAt(hash + table.rows, {begin, table.words.size() * sizeof(Word)});
  }
  return hash;
}

}  // namespace

Columns Transposed(const std::vector<Word>& rows, std::size_t width) {
  Columns columns(width == 0 ? 0 : rows.size() / width, width);
  Word* to = columns.words.data();
  for (std::size_t column = 0; column < width; ++column) {
    for (std::size_t at = column; at < rows.size(); at += width) *to++ = rows[at];
  }
  return columns;
}

std::string TablePacker::Pack(std::span<const Columns> tables) {
  std::string bytes, packed;
  for (const Columns& table : tables) {
    AppendWord(table.rows, bytes);
    AppendWord(table.width, bytes);
    for (std::size_t column = 0; column < table.width; ++column)
      AppendColumn(std::span(table.words).subspan(column * table.rows, table.rows), bytes);
  }
  AppendWord(HashOf(tables), packed);
  return packed += compressor_.Pack(bytes);
}

std::vector<Columns> TablePacker::Unpack(std::string_view packed) {
  const Word hash = TakeWord(packed);
  auto bytes = compressor_.Unpack(packed, kMostBytesOfPart);
  if (!bytes) throw Damage("a part cannot be unpacked");
  std::vector<Columns> tables;
  std::size_t left = kMostWordsOfPart;
  while (!bytes->empty()) {
    const Word rows = TakeWord(*bytes), width = TakeWord(*bytes);
    // A column has two bytes at least.
    if (width > bytes->size() / 2 || (width > 0 && rows > left / width))
      throw Damage("a part is too large");
    left -= rows * width;
    Columns& table = tables.emplace_back(rows, width);
    for (std::size_t column = 0; column < width; ++column) TakeColumn(*bytes, table.Column(column));
  }
  if (HashOf(tables) != hash)
    throw Damage("this program decodes a part otherwise than the one that wrote it");
  return tables;
}

struct Compressor::State {
  int level = 1;
  ZSTD_CCtx* packing = nullptr;
  ZSTD_DCtx* unpacking = nullptr;
  std::string packed, unpacked;
  ~State() {
    ZSTD_freeCCtx(packing);
    ZSTD_freeDCtx(unpacking);
  }
};

Compressor::Compressor(int level) : state_(std::make_unique<State>()) { state_->level = level; }
Compressor::~Compressor() = default;
Compressor::Compressor(Compressor&&) noexcept = default;

std::string_view Compressor::Pack(std::string_view bytes) {
  State& state = *state_;
  if (!state.packing) state.packing = ZSTD_createCCtx();
  state.packed.resize(std::max(state.packed.size(), ZSTD_compressBound(bytes.size())));
  const std::size_t size =
      ZSTD_compressCCtx(state.packing, state.packed.data(), state.packed.size(), bytes.data(),
                        bytes.size(), state.level);
  return std::string_view(state.packed).substr(0, ZSTD_isError(size) ? 0 : size);
}

std::optional<std::string_view> Compressor::Unpack(std::string_view packed,
                                                   std::size_t most_bytes) {
  State& state = *state_;
  const auto size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN || size > most_bytes)
    return std::nullopt;
  if (!state.unpacking) state.unpacking = ZSTD_createDCtx();
  state.unpacked.resize(std::max<std::size_t>(state.unpacked.size(), size));
  const std::size_t found = ZSTD_decompressDCtx(state.unpacking, state.unpacked.data(), size,
                                                packed.data(), packed.size());
  if (ZSTD_isError(found) || found != size) return std::nullopt;
  return std::string_view(state.unpacked).substr(0, size);
}

}  // namespace prehend::episode
