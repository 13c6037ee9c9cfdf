// SPDX-License-Identifier: Apache-2.0
// See harness/episode/frames/contact_coding.h. Tested by
// tests/harness/episode/frames/frames_test.cc
#include "harness/episode/frames/contact_coding.h"

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <numeric>

#include "harness/episode/frames/contact_guess.h"

namespace prehend::episode {
namespace {

constexpr std::size_t kValues = 8;
constexpr std::size_t kMostContacts = 1 << 24;
using Key = std::array<int, 6>;

Key KeyOf(const physics::ContactPoint& point) {
  const physics::ContactSide &a = point.a, &b = point.b;
  return {a.body.number(), a.hand.number(), a.link.number(),
          b.body.number(), b.hand.number(), b.link.number()};
}

/// Of the two sides of a point the one whose indices begin at `first`.
physics::ContactSide SideOf(const Key& key, std::size_t first) {
  return {.body = physics::BodyIndex(key[first]),
          .hand = physics::HandIndex(key[first + 1]),
          .link = physics::LinkIndex(key[first + 2])};
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
  std::vector<std::size_t> at;      ///< of each row, its place in that order
  std::vector<std::size_t> chains;  ///< of each row, the number of its chain
  std::size_t count = 0;            ///< of chains

  Chains(std::span<const Word> counts, std::span<const Word> ids, std::size_t keys)
      : order(ids.size()),
        frames(ids.size()),
        before(ids.size(), -1),
        at(ids.size()),
        chains(ids.size()) {
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
    // Sorted by counting: where the chains of each pair begin, then where each chain does.
    std::vector<std::size_t> firsts(keys + 1, 0);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      std::size_t& most = firsts[static_cast<std::size_t>(ids[i]) + 1];
      most = std::max(most, places[i] + 1);
    }
    std::partial_sum(firsts.begin(), firsts.end(), firsts.begin());
    count = firsts.back();
    for (std::size_t i = 0; i < ids.size(); ++i)
      chains[i] = firsts[static_cast<std::size_t>(ids[i])] + places[i];
    std::vector<std::size_t> begins(count + 1, 0);
    for (const std::size_t chain : chains) ++begins[chain + 1];
    std::partial_sum(begins.begin(), begins.end(), begins.begin());
    for (std::size_t i = 0; i < ids.size(); ++i) {
      at[i] = begins[chains[i]]++;
      order[at[i]] = i;
    }
    for (std::size_t i = 0; i < order.size(); ++i) {
      frames[i] = times[order[i]];
      if (i > 0 && chains[order[i]] == chains[order[i - 1]] && frames[i] == frames[i - 1] + 1)
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

/// Place and normal.
constexpr std::size_t kGeometry = 6;
using Geometry = std::array<double, kGeometry>;

Geometry GeometryOf(const physics::ContactPoint& point) {
  const Eigen::Vector3d &p = point.p_W_m, &n = point.nhat_BA_W;
  return {p.x(), p.y(), p.z(), n.x(), n.y(), n.z()};
}

Vector3 NormalIn(const Geometry& geometry) { return {geometry[3], geometry[4], geometry[5]}; }

PlacedNormal PlacedIn(const Geometry& geometry) {
  return {{geometry[0], geometry[1], geometry[2]}, NormalIn(geometry)};
}

/// Goes along a chain; encoder and decoder guess alike.
class GeometryGuess {
 public:
  void Begin(const Geometry& geometry) {
    now_ = geometry;
    rule_ = PlaceRule::kKept;
    has_pose_ = false;
  }
  /// Where the owner of the last row was.
  void KeepPose(const physics::Pose& owner) {
    from_ = has_pose_ ? to_ : owner;
    to_ = owner;
    has_pose_ = true;
  }
  /// Calls `take(column, guess)` for each value of the next row, and keeps what that returns.
  template <typename Take>
  const Geometry& Continue(double outward, const Take& take) {
    const PlacedNormal last = PlacedIn(now_);
    const int largest = LargestOf(last.n);
    const std::size_t third = 3 + static_cast<std::size_t>(largest);
    for (std::size_t column = 3; column < kGeometry; ++column) {
      if (column != third) now_[column] = take(column, now_[column]);
    }
    now_[third] = take(third, LargestGuess(largest, last.n, NormalIn(now_)));
    const std::array<Vector3, 2> places = PlacesFor(last, from_, to_, outward, NormalIn(now_));
    const Vector3& guess = places[static_cast<std::size_t>(rule_)];
    now_[0] = take(0, guess.x);
    now_[1] = take(1, guess.y);
    now_[2] = take(2, guess.z);
    rule_ = BestRule(places, {now_[0], now_[1], now_[2]});
    return now_;
  }

 private:
  Geometry now_{};
  physics::Pose from_, to_;  ///< of the owner in the two rows before
  bool has_pose_ = false;
  PlaceRule rule_ = PlaceRule::kKept;
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
  GeometryGuess guess;
  Columns off(chains.size() - chains.Starts(), kGeometry), forces(chains.size(), 2);
  std::size_t next = 0;
  for (std::size_t i = 0; i < chains.size(); ++i) {
    const physics::ContactPoint& point = points[chains.order[i]];
    const Geometry geometry = GeometryOf(point);
    if (chains.before[i] < 0) {
      for (const double value : geometry) AppendDouble(value, bytes);
      guess.Begin(geometry);
    } else {
      guess.Continue(Outward(point), [&](std::size_t column, double guessed) {
        const double value = geometry[column];
        off.At(next, column) = Distance(std::bit_cast<Word>(value), std::bit_cast<Word>(guessed));
        return value;
      });
      ++next;
    }
    if (chains.IsContinued(i)) guess.KeepPose(owners[chains.order[i]]);
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
  std::vector<Geometry> begins(starts);
  for (Geometry& begin : begins) {
    for (double& value : begin) value = TakeDouble(bytes);
  }
  const auto off = DecodeSmall(bytes, chains.size() - starts, kGeometry);
  if (!off) return false;
  const auto forces = Decode(bytes, chains.size(), 2, {.before = chains.before});
  if (!forces) return false;
  std::vector<std::size_t> started(chains.size());  // chains up to this one, in their order
  for (std::size_t i = 0, begun = 0; i < chains.size(); ++i)
    started[i] = begun += chains.before[i] < 0 ? 1 : 0;
  // Frame after frame, so that the poses of a frame are at hand when they are asked for.
  std::vector<GeometryGuess> guesses(chains.count);
  for (std::size_t row = 0; row < points.size(); ++row) {
    physics::ContactPoint& point = points[row];
    const std::size_t i = chains.at[row];
    GeometryGuess& guess = guesses[chains.chains[row]];
    Geometry now{};
    if (chains.before[i] < 0) {
      now = begins[started[i] - 1];
      guess.Begin(now);
    } else {
      now = guess.Continue(Outward(point), [&](std::size_t column, double guessed) {
        return std::bit_cast<double>(
            AtDistance(std::bit_cast<Word>(guessed), off->At(i - started[i], column)));
      });
    }
    if (chains.IsContinued(i)) guess.KeepPose(world.pose(chains.frames[i], OwnerOf(point)));
    point.p_W_m = {now[0], now[1], now[2]};
    point.nhat_BA_W = {now[3], now[4], now[5]};
    point.distance_m = std::bit_cast<double>(forces->At(i, 0));
    point.normal_impulse_n_s = std::bit_cast<double>(forces->At(i, 1));
  }
  return true;
}

}  // namespace

const physics::ContactSide& OwnerOf(const physics::ContactPoint& point) {
  return point.a.hand != physics::kNone ? point.a : point.b;
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
    if (!world.has(SideOf(key, 0)) || !world.has(SideOf(key, 3))) return std::nullopt;
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
    decoded.points[row].a = SideOf(key, 0);
    decoded.points[row].b = SideOf(key, 3);
  }
  const bool good =
      DecodeValues(Chains(decoded.counts, ids->words, keys.size()), world, bytes, decoded.points);
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
    SplitPlanes(columns.Column(column), planes, bytes.data() + begin);
  }
}

std::optional<Columns> DecodeSmall(std::string_view& bytes, std::size_t rows, std::size_t width) {
  Columns columns(rows, width);
  for (std::size_t column = 0; column < width; ++column) {
    if (bytes.empty()) return std::nullopt;
    const auto planes = static_cast<std::uint8_t>(bytes.front());
    bytes.remove_prefix(1);
    if (planes > 8 || bytes.size() < planes * rows) return std::nullopt;
    if (planes > 0) JoinPlanes(bytes.data(), planes, columns.Column(column));
    bytes.remove_prefix(planes * rows);
  }
  return columns;
}

}  // namespace prehend::episode
