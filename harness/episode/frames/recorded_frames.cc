// SPDX-License-Identifier: Apache-2.0
// See harness/episode/frames/recorded_frames.h. Tested by
// tests/harness/episode/frames/recorded_frames_test.cc
#include "harness/episode/frames/recorded_frames.h"

#include <algorithm>
#include <bit>
#include <map>

#include "harness/episode/frames/columns.h"

namespace prehend::episode {
namespace {

constexpr std::size_t kMostFrames = 480, kMostWords = 1 << 16, kMostRows = 1 << 20;
constexpr std::size_t kSampleWidth = 17, kTouchWidth = 13, kSphereWidth = 4;
/// Of a hand: trigger, style, three of its direction, the number of its collision spheres.
constexpr std::size_t kHandWidth = 6;

/// Fills a row of columns, or reads it, from left to right.
template <typename Table>
class Cells {
 public:
  Cells(Table& columns, std::size_t row) : columns_(columns), row_(row) {}
  void Put(double value) { columns_.At(row_, next_++) = std::bit_cast<Word>(value); }
  void PutInteger(std::int64_t value) { columns_.At(row_, next_++) = static_cast<Word>(value); }
  template <typename Coefficients>
  void PutAll(const Coefficients& values) {
    for (Eigen::Index i = 0; i < values.size(); ++i) Put(values[i]);
  }
  double Double() { return std::bit_cast<double>(columns_.At(row_, next_++)); }
  std::int64_t Integer() { return static_cast<std::int64_t>(columns_.At(row_, next_++)); }
  template <typename Coefficients>
  void TakeAll(Coefficients& values) {
    for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = Double();
  }

 private:
  Table& columns_;
  std::size_t row_;
  std::size_t next_ = 0;
};

void PutSample(const grammar::EntitySample& look, Columns& columns, std::size_t row) {
  Cells cells(columns, row);
  cells.PutAll(look.p_WB_m);
  cells.PutAll(look.q_WB.coeffs());
  cells.PutAll(look.v_WB_m_per_s);
  cells.PutAll(look.w_WB_rad_per_s);
  cells.PutInteger(look.asleep ? 1 : 0);
  cells.Put(look.joint_position);
  cells.Put(look.joint_fraction);
  cells.PutInteger(look.gazes_at);
}

bool TakeSample(const Columns& columns, std::size_t row, std::size_t entities,
                grammar::EntitySample& look) {
  Cells cells(columns, row);
  cells.TakeAll(look.p_WB_m);
  cells.TakeAll(look.q_WB.coeffs());
  cells.TakeAll(look.v_WB_m_per_s);
  cells.TakeAll(look.w_WB_rad_per_s);
  look.asleep = cells.Integer() != 0;
  look.joint_position = cells.Double();
  look.joint_fraction = cells.Double();
  const std::int64_t gazes_at = cells.Integer();
  if (gazes_at < grammar::kNoEntity || gazes_at >= static_cast<std::int64_t>(entities))
    return false;
  look.gazes_at = static_cast<int>(gazes_at);
  return true;
}

void PutTouch(const grammar::Touch& touch, Columns& columns, std::size_t row) {
  Cells cells(columns, row);
  cells.PutInteger(touch.a);
  cells.PutInteger(touch.b);
  cells.Put(touch.up_on_a);
  cells.Put(touch.up_on_b);
  cells.Put(touch.normal_force_n);
  cells.Put(touch.vertical_speed_m_per_s);
  cells.PutAll(touch.p_W_m);
  cells.PutAll(touch.nhat_BA_W);
  cells.PutInteger(touch.sensor_sets);
}

bool TakeTouch(const Columns& columns, std::size_t row, std::size_t entities,
               grammar::Touch& touch) {
  Cells cells(columns, row);
  const std::int64_t a = cells.Integer(), b = cells.Integer();
  if (a < 0 || b <= a || b >= static_cast<std::int64_t>(entities)) return false;
  touch.a = static_cast<int>(a);
  touch.b = static_cast<int>(b);
  touch.up_on_a = cells.Double();
  touch.up_on_b = cells.Double();
  touch.normal_force_n = cells.Double();
  touch.vertical_speed_m_per_s = cells.Double();
  cells.TakeAll(touch.p_W_m);
  cells.TakeAll(touch.nhat_BA_W);
  touch.sensor_sets = static_cast<std::uint32_t>(cells.Integer());
  return true;
}

/// Per row the row at the same place among those of its owner in the frame before, or -1.
class Continued {
 public:
  /// `count` more rows, of this owner.
  void Add(std::size_t owner, std::size_t count) {
    const Begin last = last_.contains(owner) ? last_[owner] : Begin{};
    for (std::size_t i = 0; i < count; ++i)
      before_.push_back(i < last.count ? static_cast<int>(last.row + i) : -1);
    last_[owner] = {before_.size() - count, count};
  }
  std::vector<int> before() const { return before_; }

 private:
  struct Begin {
    std::size_t row = 0, count = 0;
  };
  std::map<std::size_t, Begin> last_;
  std::vector<int> before_;
};

/// How the columns of an entity are guessed: frames have the same distance in most recordings.
Guesses MotionOf(std::span<const Word> ticks, grammar::Tick ticks_per_second) {
  if (ticks.size() < 2 || ticks_per_second < 1) return {};
  return {.dt_s = static_cast<double>(ticks[1] - ticks[0]) / static_cast<double>(ticks_per_second)};
}

Columns CountsOf(std::span<const EpisodeFrame> frames) {
  Columns counts(frames.size(), 2);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    counts.At(i, 0) = static_cast<Word>(frames[i].tick);
    counts.At(i, 1) = frames[i].touches.size();
  }
  return counts;
}

std::vector<int> HandsOf(const grammar::EntityTable& table) {
  std::vector<int> hands;
  for (std::size_t i = 0; i < table.entities.size(); ++i) {
    const std::vector<std::string>& classes = table.entities[i].classes;
    if (!classes.empty() && classes.front() == "Hand") hands.push_back(static_cast<int>(i));
  }
  return hands;
}

class RecordedDecoder {
 public:
  RecordedDecoder(std::string_view bytes, const grammar::EntityTable& table)
      : bytes_(bytes), table_(table), hands_(HandsOf(table)) {}

  std::optional<RecordedFrames> Run() {
    const std::optional<Word> frames = TakeVarint(bytes_);
    if (!frames || *frames == 0 || *frames > kMostFrames) return std::nullopt;
    result_.frames.resize(static_cast<std::size_t>(*frames));
    if (!TakeCounts() || !TakeSamples() || !TakeHands() || !TakeTouches() || !bytes_.empty())
      return std::nullopt;
    return std::move(result_);
  }

 private:
  std::size_t rows() const { return result_.frames.size(); }

  bool TakeCounts() {
    for (std::size_t i = 0; i < table_.entities.size(); ++i) {
      const std::optional<Word> placed = TakeVarint(bytes_);
      if (!placed) return false;
      result_.placed.push_back(*placed != 0);
    }
    std::optional<Columns> counts = Decode(bytes_, rows(), 2, {});
    if (!counts) return false;
    counts_ = std::move(*counts);
    std::int64_t before = -1;
    for (std::size_t i = 0; i < rows(); ++i) {
      result_.frames[i].tick = static_cast<std::int64_t>(counts_.At(i, 0));
      if (result_.frames[i].tick <= before || counts_.At(i, 1) > kMostRows) return false;
      before = result_.frames[i].tick;
    }
    return true;
  }

  bool TakeSamples() {
    const Guesses motion = MotionOf(counts_.Column(0), table_.ticks_per_second);
    for (EpisodeFrame& frame : result_.frames) frame.entities.resize(table_.entities.size());
    for (std::size_t entity = 0; entity < table_.entities.size(); ++entity) {
      const std::optional<Columns> columns = Decode(bytes_, rows(), kSampleWidth, motion);
      if (!columns) return false;
      for (std::size_t i = 0; i < rows(); ++i) {
        if (!TakeSample(*columns, i, table_.entities.size(), result_.frames[i].entities[entity]))
          return false;
      }
    }
    return true;
  }

  bool TakeHands() {
    Continued continued;
    std::vector<Columns> all;
    std::size_t spheres = 0;
    for (std::size_t hand = 0; hand < hands_.size(); ++hand) {
      std::optional<Columns> columns = Decode(bytes_, rows(), kHandWidth, {});
      if (!columns) return false;
      all.push_back(std::move(*columns));
    }
    for (std::size_t i = 0; i < rows(); ++i) {
      EpisodeFrame& frame = result_.frames[i];
      for (std::size_t hand = 0; hand < hands_.size(); ++hand) {
        Cells cells(all[hand], i);
        grammar::HandSample& sample = frame.hands.emplace_back();
        sample.entity = hands_[hand];
        sample.trigger = cells.Double();
        const std::int64_t style = cells.Integer();
        if (style < 0 || (style > 0 && style >= static_cast<std::int64_t>(table_.styles.size())))
          return false;
        sample.style = static_cast<int>(style);
        cells.TakeAll(sample.ahead_W);
        const std::int64_t count = cells.Integer();
        if (count < 0 || count > static_cast<std::int64_t>(kMostRows - spheres)) return false;
        continued.Add(hand, static_cast<std::size_t>(count));
        spheres += static_cast<std::size_t>(count);
        frame.collision_spheres.emplace_back(static_cast<std::size_t>(count));
      }
    }
    const std::optional<Columns> columns =
        Decode(bytes_, spheres, kSphereWidth, {.before = continued.before()});
    if (!columns) return false;
    std::size_t row = 0;
    for (EpisodeFrame& frame : result_.frames) {
      for (auto& of_hand : frame.collision_spheres) {
        for (grammar::CollisionSphere& sphere : of_hand) {
          Cells cells(*columns, row++);
          cells.TakeAll(sphere.p_W_m);
          sphere.radius_m = cells.Double();
        }
      }
    }
    return true;
  }

  bool TakeTouches() {
    Continued continued;
    std::size_t touches = 0;
    for (const Word count : counts_.Column(1)) {
      continued.Add(0, static_cast<std::size_t>(count));
      touches += static_cast<std::size_t>(count);
      if (touches > kMostRows) return false;
    }
    const std::optional<Columns> columns =
        Decode(bytes_, touches, kTouchWidth, {.before = continued.before()});
    if (!columns) return false;
    std::size_t row = 0;
    for (std::size_t i = 0; i < rows(); ++i) {
      std::vector<grammar::Touch>& found = result_.frames[i].touches;
      found.resize(static_cast<std::size_t>(counts_.At(i, 1)));
      for (grammar::Touch& touch : found) {
        if (!TakeTouch(*columns, row++, table_.entities.size(), touch)) return false;
      }
      const auto pair = [](const grammar::Touch& touch) { return std::pair(touch.a, touch.b); };
      if (std::ranges::adjacent_find(found, std::ranges::greater_equal{}, pair) != found.end())
        return false;
    }
    return true;
  }

  std::string_view bytes_;
  const grammar::EntityTable& table_;
  std::vector<int> hands_;
  Columns counts_;
  RecordedFrames result_;
};

void EncodeHands(std::span<const EpisodeFrame> frames, std::string& bytes) {
  const std::size_t hands = frames.front().hands.size();
  Continued continued;
  std::vector<grammar::CollisionSphere> spheres;
  std::vector<Columns> all(hands, Columns(frames.size(), kHandWidth));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (std::size_t hand = 0; hand < hands; ++hand) {
      const grammar::HandSample& sample = frames[i].hands[hand];
      const std::vector<grammar::CollisionSphere>& of_hand = frames[i].collision_spheres[hand];
      Cells cells(all[hand], i);
      cells.Put(sample.trigger);
      cells.PutInteger(sample.style);
      cells.PutAll(sample.ahead_W);
      cells.PutInteger(static_cast<std::int64_t>(of_hand.size()));
      continued.Add(hand, of_hand.size());
      spheres.insert(spheres.end(), of_hand.begin(), of_hand.end());
    }
  }
  for (const Columns& columns : all) Encode(columns, {}, bytes);
  Columns columns(spheres.size(), kSphereWidth);
  for (std::size_t row = 0; row < spheres.size(); ++row) {
    Cells cells(columns, row);
    cells.PutAll(spheres[row].p_W_m);
    cells.Put(spheres[row].radius_m);
  }
  Encode(columns, {.before = continued.before()}, bytes);
}

void EncodeTouches(std::span<const EpisodeFrame> frames, std::string& bytes) {
  Continued continued;
  std::vector<const grammar::Touch*> touches;
  for (const EpisodeFrame& frame : frames) {
    continued.Add(0, frame.touches.size());
    for (const grammar::Touch& touch : frame.touches) touches.push_back(&touch);
  }
  Columns columns(touches.size(), kTouchWidth);
  for (std::size_t row = 0; row < touches.size(); ++row) PutTouch(*touches[row], columns, row);
  Encode(columns, {.before = continued.before()}, bytes);
}

std::size_t WordsOf(const EpisodeFrame& frame) {
  std::size_t words = kSampleWidth * frame.entities.size() + kTouchWidth * frame.touches.size();
  for (const auto& spheres : frame.collision_spheres)
    words += kHandWidth + kSphereWidth * spheres.size();
  return words;
}

}  // namespace

std::size_t FramesOfChunk(std::span<const EpisodeFrame> frames) {
  std::size_t count = 0, words = 0;
  while (count < std::min(frames.size(), kMostFrames) && (count == 0 || words < kMostWords))
    words += WordsOf(frames[count++]);
  return count;
}

std::string EncodeRecordedFrames(std::span<const EpisodeFrame> frames,
                                 const std::vector<bool>& placed, grammar::Tick ticks_per_second) {
  const std::size_t entities = frames.front().entities.size();
  std::string bytes;
  AppendVarint(frames.size(), bytes);
  for (std::size_t i = 0; i < entities; ++i)
    AppendVarint(i < placed.size() && placed[i] ? 1 : 0, bytes);
  const Columns counts = CountsOf(frames);
  Encode(counts, {}, bytes);
  const Guesses motion = MotionOf(counts.Column(0), ticks_per_second);
  for (std::size_t entity = 0; entity < entities; ++entity) {
    Columns columns(frames.size(), kSampleWidth);
    for (std::size_t i = 0; i < frames.size(); ++i)
      PutSample(frames[i].entities[entity], columns, i);
    Encode(columns, motion, bytes);
  }
  EncodeHands(frames, bytes);
  EncodeTouches(frames, bytes);
  return bytes;
}

std::optional<RecordedFrames> DecodeRecordedFrames(std::string_view bytes,
                                                   const grammar::EntityTable& table) {
  return RecordedDecoder(bytes, table).Run();
}

}  // namespace prehend::episode
