// SPDX-License-Identifier: Apache-2.0
// See harness/frames/contact_coding.h. Tested by tests/harness/frames/frames_test.cc
#include "harness/frames/contact_coding.h"

#include <algorithm>
#include <array>
#include <bit>
#include <map>

namespace prehend::harness::episodes {
namespace {

constexpr std::size_t kValues = 8;
constexpr std::size_t kMostContacts = 1 << 24;
using Key = std::array<int, 6>;

Key KeyOf(const physics::ContactPoint& point) {
  return {point.a.body, point.a.hand, point.a.link, point.b.body, point.b.hand, point.b.link};
}

std::array<double, kValues> ValuesOf(const physics::ContactPoint& point) {
  const Eigen::Vector3d &p = point.p_W_m, &n = point.nhat_BA_W;
  return {p.x(), p.y(), p.z(), n.x(), n.y(), n.z(), point.distance_m, point.normal_impulse_n_s};
}

/// Per row the row at the same place of the frame before, or -1.
std::vector<int> SamePlaces(std::span<const Word> counts) {
  std::vector<int> before;
  Word last = 0, begin = 0;
  for (const Word count : counts) {
    for (Word i = 0; i < count; ++i)
      before.push_back(i < last ? static_cast<int>(begin - last + i) : -1);
    begin += count;
    last = count;
  }
  return before;
}

/// Per row the row of the frame before that has the same sides, or -1; of several the n-th.
std::vector<int> SameSides(std::span<const Word> counts, std::span<const Word> ids,
                           std::size_t keys) {
  std::vector<int> before(ids.size(), -1);
  std::vector<std::vector<int>> last(keys), now(keys);
  std::vector<std::size_t> used;
  std::size_t row = 0;
  for (const Word count : counts) {
    std::vector<std::size_t> used_now;
    for (Word i = 0; i < count; ++i, ++row) {
      const auto id = static_cast<std::size_t>(ids[row]);
      if (now[id].empty()) used_now.push_back(id);
      if (now[id].size() < last[id].size()) before[row] = last[id][now[id].size()];
      now[id].push_back(static_cast<int>(row));
    }
    for (const std::size_t id : used) last[id].clear();
    for (const std::size_t id : used_now) {
      std::swap(last[id], now[id]);
      now[id].clear();
    }
    used = std::move(used_now);
  }
  return before;
}

Columns OneColumn(const std::vector<Word>& words) {
  Columns columns(words.size(), 1);
  columns.words = words;
  return columns;
}

}  // namespace

bool SamePoint(const physics::ContactPoint& a, const physics::ContactPoint& b) {
  return KeyOf(a) == KeyOf(b) && std::bit_cast<std::array<Word, kValues>>(ValuesOf(a)) ==
                                     std::bit_cast<std::array<Word, kValues>>(ValuesOf(b));
}

void EncodeContacts(const std::vector<Word>& counts,
                    const std::vector<physics::ContactPoint>& points, std::string& bytes) {
  std::map<Key, Word> known;
  std::vector<Key> keys;
  std::vector<Word> ids;
  Columns values(points.size(), kValues);
  for (std::size_t row = 0; row < points.size(); ++row) {
    const auto [found, is_new] = known.try_emplace(KeyOf(points[row]), keys.size());
    if (is_new) keys.push_back(found->first);
    ids.push_back(found->second);
    const std::array<double, kValues> all = ValuesOf(points[row]);
    for (std::size_t i = 0; i < kValues; ++i) values.At(row, i) = std::bit_cast<Word>(all[i]);
  }
  AppendVarint(counts.size(), bytes);
  AppendVarint(points.size(), bytes);
  AppendVarint(keys.size(), bytes);
  for (const Key& key : keys) {
    for (const int index : key) AppendVarint(static_cast<Word>(index + 1), bytes);
  }
  Encode(OneColumn(counts), {}, bytes);
  if (points.empty()) return;
  Encode(OneColumn(ids), {.before = SamePlaces(counts)}, bytes);
  Encode(values, {.before = SameSides(counts, ids, keys.size())}, bytes);
}

std::optional<DecodedContacts> DecodeContacts(std::string_view& bytes) {
  const std::optional<Word> frames = TakeVarint(bytes), rows = TakeVarint(bytes),
                            key_count = TakeVarint(bytes);
  if (!frames || !rows || !key_count || *frames > kMostContacts || *rows > kMostContacts ||
      *key_count > *rows)
    return std::nullopt;
  std::vector<Key> keys(static_cast<std::size_t>(*key_count));
  for (Key& key : keys) {
    for (int& index : key) {
      const std::optional<Word> word = TakeVarint(bytes);
      if (!word || *word > kMostContacts) return std::nullopt;
      index = static_cast<int>(*word) - 1;
    }
  }
  const std::optional<Columns> counts = Decode(bytes, static_cast<std::size_t>(*frames), 1, {});
  if (!counts) return std::nullopt;
  Word sum = 0;
  for (const Word count : counts->words) {
    if (count > *rows) return std::nullopt;
    sum += count;
  }
  if (sum != *rows) return std::nullopt;
  DecodedContacts decoded{.counts = counts->words, .points = {}};
  if (*rows == 0) return decoded;
  const auto size = static_cast<std::size_t>(*rows);
  const std::optional<Columns> ids = Decode(bytes, size, 1, {.before = SamePlaces(decoded.counts)});
  if (!ids || std::ranges::any_of(ids->words, [&](Word id) { return id >= keys.size(); }))
    return std::nullopt;
  const std::optional<Columns> values =
      Decode(bytes, size, kValues, {.before = SameSides(decoded.counts, ids->words, keys.size())});
  if (!values) return std::nullopt;
  decoded.points.resize(size);
  for (std::size_t row = 0; row < size; ++row) {
    physics::ContactPoint& point = decoded.points[row];
    const Key& key = keys[static_cast<std::size_t>(ids->words[row])];
    point.a = {key[0], key[1], key[2]};
    point.b = {key[3], key[4], key[5]};
    const auto value = [&](std::size_t i) { return std::bit_cast<double>(values->At(row, i)); };
    point.p_W_m = {value(0), value(1), value(2)};
    point.nhat_BA_W = {value(3), value(4), value(5)};
    point.distance_m = value(6);
    point.normal_impulse_n_s = value(7);
  }
  return decoded;
}

Word OffBy(double value, double guess) {
  const Word difference = std::bit_cast<Word>(value) - std::bit_cast<Word>(guess);
  return (difference << 1) ^ (difference >> 63 ? ~Word{0} : Word{0});
}

double ValueOffBy(double guess, Word off) {
  const Word difference = (off >> 1) ^ (off & 1 ? ~Word{0} : Word{0});
  return std::bit_cast<double>(std::bit_cast<Word>(guess) + difference);
}

void EncodeSmall(const Columns& columns, std::string& bytes) {
  for (std::size_t column = 0; column < columns.width; ++column) {
    Word all = 0;
    for (const Word word : columns.Column(column)) all |= word;
    const int planes = (std::bit_width(all) + 7) / 8;
    bytes += static_cast<char>(planes);
    for (int plane = 0; plane < planes; ++plane) {
      for (const Word word : columns.Column(column))
        bytes += static_cast<char>(word >> (8 * plane));
    }
  }
}

std::optional<Columns> DecodeSmall(std::string_view& bytes, std::size_t rows, std::size_t width) {
  Columns columns(rows, width);
  for (std::size_t column = 0; column < width; ++column) {
    if (bytes.empty()) return std::nullopt;
    const auto planes = static_cast<std::uint8_t>(bytes.front());
    bytes.remove_prefix(1);
    if (planes > 8 || bytes.size() < planes * rows) return std::nullopt;
    for (int plane = 0; plane < planes; ++plane) {
      std::size_t row = 0;
      for (Word& word : columns.Column(column))
        word |= Word{static_cast<std::uint8_t>(bytes[row++])} << (8 * plane);
      bytes.remove_prefix(rows);
    }
  }
  return columns;
}

}  // namespace prehend::harness::episodes
