// SPDX-License-Identifier: Apache-2.0
// See harness/frames/contact_coding.h. Tested by tests/harness/frames/frames_test.cc
#include "harness/frames/contact_coding.h"

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <numeric>

#include "harness/frames/contact_guess.h"

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

/// Points by pair and by place in it, each where it is in time.
struct Chains {
  std::vector<std::size_t> order;   ///< of the rows
  std::vector<std::size_t> frames;  ///< of the rows in that order
  std::vector<int> before;          ///< in that order: the one that a row continues, or -1

  Chains(std::span<const Word> counts, std::span<const Word> ids, std::size_t keys)
      : order(ids.size()), frames(ids.size()), before(ids.size(), -1) {
    std::vector<std::size_t> places(ids.size()), times(ids.size()), used(keys, 0);
    std::size_t row = 0;
    for (std::size_t frame = 0; frame < counts.size(); ++frame) {
      const std::size_t begin = row;
      for (; row < begin + counts[frame]; ++row) {
        places[row] = used[static_cast<std::size_t>(ids[row])]++;
        times[row] = frame;
      }
      for (std::size_t i = begin; i < row; ++i) used[static_cast<std::size_t>(ids[i])] = 0;
    }
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto chain = [&](std::size_t i) { return std::pair(ids[i], places[i]); };
    std::ranges::stable_sort(order, {}, chain);
    for (std::size_t i = 0; i < order.size(); ++i) {
      frames[i] = times[order[i]];
      if (i > 0 && chain(order[i]) == chain(order[i - 1]) && frames[i] == frames[i - 1] + 1)
        before[i] = static_cast<int>(i) - 1;
    }
  }
  std::size_t size() const { return order.size(); }
  std::size_t Starts() const { return static_cast<std::size_t>(std::ranges::count(before, -1)); }
  bool IsContinued(std::size_t i) const {
    return i + 1 < before.size() && before[i + 1] == static_cast<int>(i);
  }
};

double Outward(const physics::ContactPoint& point) {
  return &OwnerOf(point) == &point.b ? 1.0 : -1.0;
}

/// The columns of place and normal.
constexpr std::size_t kGeometry = 6;

double& ValueAt(PlacedNormal& geometry, std::size_t column) {
  Vector3& v = column < 3 ? geometry.p : geometry.n;
  return column % 3 == 0 ? v.x : column % 3 == 1 ? v.y : v.z;
}

PlacedNormal GeometryOf(const physics::ContactPoint& point) {
  return {ToVector3(point.p_W_m), ToVector3(point.nhat_BA_W)};
}

/// Goes along the chains; encoder and decoder guess alike.
class GeometryGuess {
 public:
  explicit GeometryGuess(const Chains& chains)
      : chains_(chains), known_(chains.size()), poses_(chains.size()), rules_(chains.size()) {}

  /// Calls `take(column, guess)` for each value of the i-th row that continues another one, and
  /// keeps what that returns.
  template <typename Take>
  const PlacedNormal& Continue(std::size_t i, double outward, const Take& take) {
    const auto before = static_cast<std::size_t>(chains_.before[i]);
    PlacedNormal& now = known_[i];
    PlacedNormal last = known_[before];
    const int largest = LargestOf(last.n);
    const std::size_t third = 3 + static_cast<std::size_t>(largest);
    for (std::size_t column = 3; column < kGeometry; ++column) {
      if (column != third) ValueAt(now, column) = take(column, ValueAt(last, column));
    }
    ValueAt(now, third) = take(third, LargestGuess(largest, last.n, now.n));
    const int earlier = chains_.before[before];
    const physics::Pose& to = poses_[before];
    const physics::Pose& from = earlier < 0 ? to : poses_[static_cast<std::size_t>(earlier)];
    const std::array<Vector3, 2> places = PlacesFor(last, from, to, outward, now.n);
    PlacedNormal guess{places[static_cast<std::size_t>(rules_[before])], {}};
    for (std::size_t column = 0; column < 3; ++column)
      ValueAt(now, column) = take(column, ValueAt(guess, column));
    rules_[i] = BestRule(places, now.p);
    return now;
  }
  void Begin(std::size_t i, const PlacedNormal& geometry) { known_[i] = geometry; }
  void KeepPose(std::size_t i, const physics::Pose& owner) { poses_[i] = owner; }

 private:
  const Chains& chains_;
  std::vector<PlacedNormal> known_;
  std::vector<physics::Pose> poses_;
  std::vector<PlaceRule> rules_;
};

void AppendDouble(double value, std::string& bytes) {
  const Word word = std::bit_cast<Word>(value);
  for (int i = 0; i < 8; ++i) bytes += static_cast<char>(word >> (8 * i));
}

double TakeDouble(std::string_view& bytes) {
  Word word = 0;
  for (int i = 0; i < 8; ++i) word |= Word{static_cast<std::uint8_t>(bytes[i])} << (8 * i);
  bytes.remove_prefix(8);
  return std::bit_cast<double>(word);
}

void EncodeValues(const Chains& chains, const std::vector<physics::ContactPoint>& points,
                  const std::vector<physics::Pose>& owners, std::string& bytes) {
  GeometryGuess guess(chains);
  Columns off(chains.size() - chains.Starts(), kGeometry), forces(chains.size(), 2);
  std::size_t next = 0;
  for (std::size_t i = 0; i < chains.size(); ++i) {
    const physics::ContactPoint& point = points[chains.order[i]];
    PlacedNormal geometry = GeometryOf(point);
    if (chains.before[i] < 0) {
      for (std::size_t column = 0; column < kGeometry; ++column)
        AppendDouble(ValueAt(geometry, column), bytes);
      guess.Begin(i, geometry);
    } else {
      guess.Continue(i, Outward(point), [&](std::size_t column, double guessed) {
        const double value = ValueAt(geometry, column);
        off.At(next, column) = Distance(std::bit_cast<Word>(value), std::bit_cast<Word>(guessed));
        return value;
      });
      ++next;
    }
    if (chains.IsContinued(i)) guess.KeepPose(i, owners[chains.order[i]]);
    forces.At(i, 0) = std::bit_cast<Word>(point.distance_m);
    forces.At(i, 1) = std::bit_cast<Word>(point.normal_impulse_n_s);
  }
  EncodeSmall(off, bytes);
  Encode(forces, {.before = chains.before}, bytes);
}

/// `points` have their sides. False: damaged.
bool DecodeValues(const Chains& chains, const ContactWorld& world, std::string_view& bytes,
                  std::vector<physics::ContactPoint>& points) {
  const std::size_t starts = chains.Starts();
  if (bytes.size() < 8 * kGeometry * starts) return false;
  std::string_view begins = bytes.substr(0, 8 * kGeometry * starts);
  bytes.remove_prefix(begins.size());
  const auto off = DecodeSmall(bytes, chains.size() - starts, kGeometry);
  if (!off) return false;
  const auto forces = Decode(bytes, chains.size(), 2, {.before = chains.before});
  if (!forces) return false;
  GeometryGuess guess(chains);
  std::size_t next = 0;
  for (std::size_t i = 0; i < chains.size(); ++i) {
    physics::ContactPoint& point = points[chains.order[i]];
    PlacedNormal now;
    if (chains.before[i] < 0) {
      for (std::size_t column = 0; column < kGeometry; ++column)
        ValueAt(now, column) = TakeDouble(begins);
      guess.Begin(i, now);
    } else {
      now = guess.Continue(i, Outward(point), [&](std::size_t column, double guessed) {
        return std::bit_cast<double>(
            AtDistance(std::bit_cast<Word>(guessed), off->At(next, column)));
      });
      ++next;
    }
    if (chains.IsContinued(i)) guess.KeepPose(i, world.pose(chains.frames[i], OwnerOf(point)));
    point.p_W_m = {now.p.x, now.p.y, now.p.z};
    point.nhat_BA_W = {now.n.x, now.n.y, now.n.z};
    point.distance_m = std::bit_cast<double>(forces->At(i, 0));
    point.normal_impulse_n_s = std::bit_cast<double>(forces->At(i, 1));
  }
  return true;
}

/// The same of version 1, in the order of the rows.
bool DecodeOldValues(std::span<const Word> counts, std::span<const Word> ids, std::size_t keys,
                     std::string_view& bytes, std::vector<physics::ContactPoint>& points) {
  const auto values =
      Decode(bytes, points.size(), kValues, {.before = SameSides(counts, ids, keys)});
  if (!values) return false;
  for (std::size_t row = 0; row < points.size(); ++row) {
    const auto value = [&](std::size_t i) { return std::bit_cast<double>(values->At(row, i)); };
    points[row].p_W_m = {value(0), value(1), value(2)};
    points[row].nhat_BA_W = {value(3), value(4), value(5)};
    points[row].distance_m = value(6);
    points[row].normal_impulse_n_s = value(7);
  }
  return true;
}

}  // namespace

const physics::ContactSide& OwnerOf(const physics::ContactPoint& point) {
  return point.a.hand >= 0 ? point.a : point.b;
}

bool SamePoint(const physics::ContactPoint& a, const physics::ContactPoint& b) {
  return KeyOf(a) == KeyOf(b) && std::bit_cast<std::array<Word, kValues>>(ValuesOf(a)) ==
                                     std::bit_cast<std::array<Word, kValues>>(ValuesOf(b));
}

void EncodeContacts(const std::vector<Word>& counts,
                    const std::vector<physics::ContactPoint>& points,
                    const std::vector<physics::Pose>& owners, std::string& bytes) {
  std::map<Key, Word> known;
  std::vector<Key> keys;
  std::vector<Word> ids;
  for (const physics::ContactPoint& point : points) {
    const auto [found, is_new] = known.try_emplace(KeyOf(point), keys.size());
    if (is_new) keys.push_back(found->first);
    ids.push_back(found->second);
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
  EncodeValues(Chains(counts, ids, keys.size()), points, owners, bytes);
}

std::optional<DecodedContacts> DecodeContacts(std::string_view& bytes, const ContactWorld& world) {
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
    if (!world.has({key[0], key[1], key[2]}) || !world.has({key[3], key[4], key[5]}))
      return std::nullopt;
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
  decoded.points.resize(size);
  for (std::size_t row = 0; row < size; ++row) {
    const Key& key = keys[static_cast<std::size_t>(ids->words[row])];
    decoded.points[row].a = {key[0], key[1], key[2]};
    decoded.points[row].b = {key[3], key[4], key[5]};
  }
  const bool good =
      world.version == 1
          ? DecodeOldValues(decoded.counts, ids->words, keys.size(), bytes, decoded.points)
          : DecodeValues(Chains(decoded.counts, ids->words, keys.size()), world, bytes,
                         decoded.points);
  if (!good) return std::nullopt;
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
    const std::size_t begin = bytes.size();
    bytes.resize(begin + static_cast<std::size_t>(planes) * columns.rows);
    char* out = bytes.data() + begin;
    for (int plane = 0; plane < planes; ++plane) {
      for (const Word word : columns.Column(column))
        *out++ = static_cast<char>(word >> (8 * plane));
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
