// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/frames/frame_layout.h"

#include <algorithm>
#include <span>
#include <tuple>

namespace prehend::episode {
namespace {

void EachMotion(auto& cells, auto& body) {
  cells(body.X_WB.p_m, body.X_WB.q, body.v_WB_m_per_s, body.w_WB_rad_per_s);
}

void EachOfPoint(auto& cells, auto& point) {
  for (auto* side : {&point.a, &point.b}) cells(side->body, side->hand, side->link);
  cells(point.p_W_m, point.nhat_BA_W, point.distance_m, point.normal_impulse_n_s);
}

void EachOfTrack(const FrameLayout& layout, std::size_t track, auto& snapshot, auto& cells) {
  if (track < layout.bodies) {
    auto& body = snapshot.bodies[track];
    EachMotion(cells, body);
    cells(body.asleep);
  } else if (track < layout.Joints()) {
    std::size_t first = 0;
    for (std::size_t i = layout.bodies; i < track; ++i) first += layout.grains[i - layout.bodies];
    for (auto& grain :
         std::span(snapshot.grains).subspan(first, layout.grains[track - layout.bodies]))
      cells(grain);
  } else if (track < layout.FirstHand()) {
    for (auto& joint : snapshot.joints) cells(joint.position, joint.fraction);
  } else if (track < layout.Gazes()) {
    auto& hand = snapshot.hands[track - layout.FirstHand()];
    EachMotion(cells, hand.palm);
    cells(hand.X_WTarget.p_m, hand.X_WTarget.q, hand.trigger, hand.style);
    for (auto& joint : hand.joints) cells(joint);
  } else {
    for (auto& gaze : snapshot.gazes)
      cells(gaze.p_WE_m, gaze.toward_W, gaze.body, gaze.hand, gaze.distance_m);
  }
}

template <typename Thing>
bool IsIndexOrNone(physics::Index<Thing> index, std::size_t size) {
  return index == physics::kNone || index.IsBelow(size);
}

bool IsSide(const FrameLayout& layout, const physics::ContactSide& side) {
  if (side.hand == physics::kNone) return side.body.IsBelow(layout.bodies);
  return side.hand.IsBelow(layout.hands.size()) &&
         IsIndexOrNone(side.link, At(layout.hands, side.hand).links.size());
}

constexpr std::size_t kMostFrames = 480, kMostWords = 1 << 16;
constexpr std::size_t kSampleWidth = 17, kHandWidth = 5, kTouchWidth = 13, kSphereWidth = 4;
/// The tables of a chunk: whether each entity has been placed; the frames, a row each; collision
/// spheres, with the number of their frame and hand; touches, with that of their frame.
enum Table { kPlaced, kFrames, kSpheres, kTouches, kTables };

void EachOfSample(auto& cells, auto& look) {
  cells(look.p_WB_m, look.q_WB, look.v_WB_m_per_s, look.w_WB_rad_per_s);
  cells.Flags(look.asleep, look.bridged);
  cells(look.joint_position, look.joint_fraction, look.gazes_at);
}

void EachOfHand(auto& cells, auto& hand) { cells(hand.trigger, hand.style, hand.ahead_W); }

void EachOfFrame(auto& cells, auto& frame) {
  cells(frame.tick);
  for (auto& look : frame.entities) EachOfSample(cells, look);
  for (auto& hand : frame.hands) EachOfHand(cells, hand);
}

void EachOfSphere(auto& cells, auto& sphere) { cells(sphere.p_W_m, sphere.radius_m); }

void EachOfTouch(auto& cells, auto& touch) {
  cells(touch.a, touch.b, touch.up_on_a, touch.up_on_b, touch.normal_force_n,
        touch.vertical_speed_m_per_s, touch.p_W_m, touch.nhat_BA_W, touch.sensor_sets);
}

bool IsIndex(int index, std::size_t size) {
  return index >= 0 && static_cast<std::size_t>(index) < size;
}

/// A frame with everything that these entities have.
EpisodeFrame BlankFrame(const grammar::EntityTable& table) {
  EpisodeFrame frame;
  frame.entities.resize(table.entities.size());
  for (std::size_t i = 0; i < table.entities.size(); ++i) {
    const std::vector<std::string>& classes = table.entities[i].classes;
    if (!classes.empty() && classes.front() == "Hand")
      frame.hands.push_back({.entity = static_cast<int>(i)});
  }
  frame.collision_spheres.resize(frame.hands.size());
  return frame;
}

bool IsGood(const EpisodeFrame& frame, const grammar::EntityTable& table) {
  const auto pair = [](const grammar::Touch& touch) { return std::pair(touch.a, touch.b); };
  const std::size_t entities = table.entities.size();
  return std::ranges::all_of(frame.entities,
                             [&](const grammar::EntitySample& look) {
                               return look.gazes_at == grammar::kNoEntity ||
                                      IsIndex(look.gazes_at, entities);
                             }) &&
         std::ranges::all_of(frame.hands,
                             [&](const grammar::HandSample& hand) {
                               return hand.style == 0 || IsIndex(hand.style, table.styles.size());
                             }) &&
         std::ranges::all_of(frame.touches,
                             [&](const grammar::Touch& touch) {
                               return touch.a >= 0 && touch.a < touch.b &&
                                      IsIndex(touch.b, entities);
                             }) &&
         std::ranges::adjacent_find(frame.touches, std::ranges::greater_equal{}, pair) ==
             frame.touches.end();
}

/// What stands at the same place in the frame before stands above it.
Columns SphereTable(std::span<const EpisodeFrame> frames) {
  struct Row {
    std::size_t hand, place, frame;
    auto operator<=>(const Row&) const = default;
  };
  std::vector<Row> rows;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (std::size_t hand = 0; hand < frames[i].collision_spheres.size(); ++hand) {
      for (std::size_t k = 0; k < frames[i].collision_spheres[hand].size(); ++k)
        rows.push_back({hand, k, i});
    }
  }
  std::ranges::sort(rows);
  std::vector<Word> words;
  CellWriter cells(words);
  for (const Row& row : rows) {
    cells(row.frame, row.hand);
    EachOfSphere(cells, frames[row.frame].collision_spheres[row.hand][row.place]);
  }
  return Transposed(words, 2 + kSphereWidth);
}

/// The touch of the same two in the frame before stands above it.
Columns TouchTable(std::span<const EpisodeFrame> frames) {
  std::vector<std::pair<std::size_t, const grammar::Touch*>> rows;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (const grammar::Touch& touch : frames[i].touches) rows.emplace_back(i, &touch);
  }
  std::ranges::sort(rows, {}, [](const auto& row) {
    return std::tuple(row.second->a, row.second->b, row.first);
  });
  std::vector<Word> words;
  CellWriter cells(words);
  for (const auto& [frame, touch] : rows) {
    cells(frame);
    EachOfTouch(cells, *touch);
  }
  return Transposed(words, 1 + kTouchWidth);
}

}  // namespace

FrameLayout LayoutOf(const physics::Scene& scene) {
  FrameLayout layout{
      .bodies = scene.bodies.size(), .joints = scene.joints.size(), .gazes = scene.persons.size()};
  for (const physics::Body& body : scene.bodies) {
    if (body.grains) layout.grains.push_back(body.grains->p_WG_m.size());
  }
  for (const physics::Hand& hand : scene.hands) layout.hands.push_back(hand.model);
  return layout;
}

void AppendRow(const FrameLayout& layout, std::size_t track, const physics::Snapshot& snapshot,
               std::vector<Word>& row) {
  CellWriter cells(row);
  EachOfTrack(layout, track, snapshot, cells);
}

void ReadRow(const FrameLayout& layout, std::size_t track, const Columns& columns, std::size_t row,
             physics::Snapshot& snapshot) {
  CellReader cells(columns, row);
  EachOfTrack(layout, track, snapshot, cells);
  bool is_good = true;
  if (track >= layout.FirstHand() && track < layout.Gazes()) {
    const std::size_t hand = track - layout.FirstHand();
    const int style = snapshot.hands[hand].style;
    const auto styles = static_cast<int>(layout.hands[hand].styles.size());
    is_good = style >= 0 && style < std::max(styles, 1);
  } else if (track >= layout.Gazes()) {
    is_good = std::ranges::all_of(snapshot.gazes, [&](const physics::GazeState& gaze) {
      return IsIndexOrNone(gaze.body, layout.bodies) &&
             IsIndexOrNone(gaze.hand, layout.hands.size());
    });
  }
  if (!is_good) throw Damage("a frame names what is not there");
}

std::size_t WidthOf(const FrameLayout& layout, std::size_t track) {
  std::vector<Word> row;
  AppendRow(layout, track, BlankSnapshot(layout), row);
  return row.size();
}

void AppendLinks(const std::vector<physics::Pose>& X_WL, std::vector<Word>& row) {
  CellWriter cells(row);
  for (const physics::Pose& pose : X_WL) cells(pose.p_m, pose.q);
}

void ReadLinks(const Columns& columns, std::size_t row, std::vector<physics::Pose>& X_WL) {
  CellReader cells(columns, row);
  for (physics::Pose& pose : X_WL) cells(pose.p_m, pose.q);
}

Columns TableOfPoints(const std::vector<const ContactPoints*>& moments) {
  struct Row {
    const physics::ContactPoint* point;
    std::size_t place, moment;  ///< place: among those of the same sides
    auto Key() const { return std::tie(point->a, point->b, place, moment); }
  };
  std::vector<Row> rows;
  for (std::size_t moment = 0; moment < moments.size(); ++moment) {
    if (!moments[moment]) continue;
    for (const physics::ContactPoint& point : *moments[moment]) {
      const Row* before = rows.empty() || rows.back().moment != moment ? nullptr : &rows.back();
      const bool same = before && before->point->a == point.a && before->point->b == point.b;
      rows.push_back({&point, same ? before->place + 1 : 0, moment});
    }
  }
  std::ranges::sort(rows, {}, &Row::Key);
  std::vector<Word> words;
  CellWriter cells(words);
  for (const Row& row : rows) {
    cells(row.moment);
    EachOfPoint(cells, *row.point);
  }
  return Transposed(words, kPointWidth);
}

std::vector<ContactPoints> PointsOfTable(const FrameLayout& layout, const Columns& table,
                                         std::size_t moments) {
  std::vector<ContactPoints> points(moments);
  if (table.width != kPointWidth) throw Damage("contact points have too few columns");
  std::vector<std::size_t> counts(moments);
  for (std::size_t row = 0; row < table.rows; ++row)
    if (table.At(row, 0) < moments) ++counts[table.At(row, 0)];
  for (std::size_t moment = 0; moment < moments; ++moment) points[moment].reserve(counts[moment]);
  for (std::size_t row = 0; row < table.rows; ++row) {
    CellReader cells(table, row);
    std::size_t moment = 0;
    physics::ContactPoint point;
    cells(moment);
    EachOfPoint(cells, point);
    if (moment >= moments || !IsSide(layout, point.a) || !IsSide(layout, point.b))
      throw Damage("a contact point is of nothing");
    points[moment].push_back(point);
  }
  return points;
}

physics::Snapshot BlankSnapshot(const FrameLayout& layout) {
  physics::Snapshot blank;
  blank.bodies.resize(layout.bodies);
  std::size_t grains = 0;
  for (const std::size_t count : layout.grains) grains += count;
  blank.grains.assign(grains, Eigen::Vector3d::Zero());
  blank.joints.resize(layout.joints);
  blank.gazes.resize(layout.gazes);
  for (const physics::HandModel& model : layout.hands) {
    physics::HandState& hand = blank.hands.emplace_back();
    hand.joints.assign(model.links.size(), 0.0);
    hand.X_WL.resize(model.links.size());
  }
  blank.moved_tick.assign(layout.bodies, 0);
  return blank;
}

std::size_t FramesOfChunk(std::span<const EpisodeFrame> frames) {
  std::size_t count = 0, words = 0;
  while (count < std::min(frames.size(), kMostFrames) && (count == 0 || words < kMostWords)) {
    const EpisodeFrame& frame = frames[count++];
    words += kSampleWidth * frame.entities.size() + kTouchWidth * frame.touches.size();
    for (const auto& spheres : frame.collision_spheres)
      words += kHandWidth + kSphereWidth * spheres.size();
  }
  return count;
}

std::vector<Columns> TablesOfFrames(std::span<const EpisodeFrame> frames,
                                    const std::vector<bool>& placed) {
  const std::size_t entities = frames.front().entities.size();
  std::vector<Columns> tables(kTables);
  tables[kPlaced] = Columns(entities, 1);
  for (std::size_t i = 0; i < entities; ++i)
    tables[kPlaced].At(i, 0) = i < placed.size() && placed[i] ? 1 : 0;
  std::vector<Word> words;
  CellWriter cells(words);
  for (const EpisodeFrame& frame : frames) EachOfFrame(cells, frame);
  tables[kFrames] = Transposed(words, words.size() / frames.size());
  tables[kSpheres] = SphereTable(frames);
  tables[kTouches] = TouchTable(frames);
  return tables;
}

RecordedFrames FramesOfTables(const std::vector<Columns>& tables,
                              const grammar::EntityTable& entities) {
  const EpisodeFrame blank = BlankFrame(entities);
  const std::size_t width =
      1 + kSampleWidth * blank.entities.size() + kHandWidth * blank.hands.size();
  if (tables.size() != kTables || tables[kPlaced].words.size() != blank.entities.size() ||
      tables[kFrames].rows == 0 || tables[kFrames].rows > kMostFrames ||
      tables[kFrames].width != width || tables[kSpheres].width != 2 + kSphereWidth ||
      tables[kTouches].width != 1 + kTouchWidth)
    throw Damage("a part is of other entities");
  RecordedFrames recorded;
  for (const Word placed : tables[kPlaced].words) recorded.placed.push_back(placed != 0);
  std::vector<EpisodeFrame>& frames = recorded.frames;
  frames.assign(tables[kFrames].rows, blank);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    CellReader cells(tables[kFrames], i);
    EachOfFrame(cells, frames[i]);
    if (frames[i].tick < 0 || (i > 0 && frames[i].tick <= frames[i - 1].tick))
      throw Damage("their ticks do not increase");
  }
  for (std::size_t row = 0; row < tables[kSpheres].rows; ++row) {
    CellReader cells(tables[kSpheres], row);
    std::size_t frame = 0, hand = 0;
    cells(frame, hand);
    if (frame >= frames.size() || hand >= blank.hands.size())
      throw Damage("a collision sphere is of no hand");
    EachOfSphere(cells, frames[frame].collision_spheres[hand].emplace_back());
  }
  for (std::size_t row = 0; row < tables[kTouches].rows; ++row) {
    CellReader cells(tables[kTouches], row);
    std::size_t frame = 0;
    cells(frame);
    if (frame >= frames.size()) throw Damage("a touch is in no frame");
    EachOfTouch(cells, frames[frame].touches.emplace_back());
  }
  if (!std::ranges::all_of(frames, [&](const EpisodeFrame& f) { return IsGood(f, entities); }))
    throw Damage("a frame names what is not there");
  return recorded;
}

}  // namespace prehend::episode
