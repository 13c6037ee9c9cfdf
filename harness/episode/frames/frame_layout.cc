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

}  // namespace prehend::episode
