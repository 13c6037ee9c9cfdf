// SPDX-License-Identifier: Apache-2.0
// See harness/episode/frames/frame_layout.h. Tested by tests/harness/episode/frames/frames_test.cc
#include "harness/episode/frames/frame_layout.h"

#include <algorithm>
#include <bit>

namespace prehend::episode {
namespace {

constexpr std::size_t kBodyWidth = 14, kHandOwnWidth = 13 + 7 + 2, kGazeWidth = 9;

/// Puts values into a row, one after another.
class RowWriter {
 public:
  explicit RowWriter(std::span<Word> row) : row_(row) {}
  void Put(double value) { row_[next_++] = std::bit_cast<Word>(value); }
  void PutInteger(std::int64_t value) { row_[next_++] = static_cast<Word>(value); }
  void Put(const Eigen::Vector3d& v) {
    for (int i = 0; i < 3; ++i) Put(v[i]);
  }
  void Put(const Eigen::Quaterniond& q) {
    for (int i = 0; i < 4; ++i) Put(q.coeffs()[i]);
  }

 private:
  std::span<Word> row_;
  std::size_t next_ = 0;
};

class RowReader {
 public:
  RowReader(const Columns& columns, std::size_t row) : columns_(columns), row_(row) {}
  double Double() { return std::bit_cast<double>(columns_.At(row_, next_++)); }
  int Integer() { return static_cast<int>(static_cast<std::int64_t>(columns_.At(row_, next_++))); }
  void Take(Eigen::Vector3d& v) {
    for (int i = 0; i < 3; ++i) v[i] = Double();
  }
  void Take(Eigen::Quaterniond& q) {
    for (int i = 0; i < 4; ++i) q.coeffs()[i] = Double();
  }

 private:
  const Columns& columns_;
  std::size_t row_;
  std::size_t next_ = 0;
};

void PutMotion(const physics::BodyState& body, RowWriter& row) {
  row.Put(body.X_WB.p_m);
  row.Put(body.X_WB.q);
  row.Put(body.v_WB_m_per_s);
  row.Put(body.w_WB_rad_per_s);
}

void TakeMotion(RowReader& row, physics::BodyState& body) {
  row.Take(body.X_WB.p_m);
  row.Take(body.X_WB.q);
  row.Take(body.v_WB_m_per_s);
  row.Take(body.w_WB_rad_per_s);
}

void PutHand(const physics::HandState& hand, RowWriter& row) {
  PutMotion(hand.palm, row);
  row.Put(hand.X_WTarget.p_m);
  row.Put(hand.X_WTarget.q);
  row.Put(hand.trigger);
  row.PutInteger(hand.style);
  for (const double joint : hand.joints) row.Put(joint);
}

void TakeHand(RowReader& row, physics::HandState& hand) {
  TakeMotion(row, hand.palm);
  row.Take(hand.X_WTarget.p_m);
  row.Take(hand.X_WTarget.q);
  hand.trigger = row.Double();
  hand.style = row.Integer();
  for (double& joint : hand.joints) joint = row.Double();
}

void PutGaze(const physics::GazeState& gaze, RowWriter& row) {
  row.Put(gaze.p_WE_m);
  row.Put(gaze.toward_W);
  row.PutInteger(gaze.body.number());
  row.PutInteger(gaze.hand.number());
  row.Put(gaze.distance_m);
}

void TakeGaze(RowReader& row, physics::GazeState& gaze) {
  row.Take(gaze.p_WE_m);
  row.Take(gaze.toward_W);
  gaze.body = physics::BodyIndex(row.Integer());
  gaze.hand = physics::HandIndex(row.Integer());
  gaze.distance_m = row.Double();
}

/// The grains of the n-th body that is grains.
std::span<Eigen::Vector3d> GrainsAt(const FrameLayout& layout, std::size_t n,
                                    physics::Snapshot& snapshot) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < n; ++i) first += layout.grains[i];
  return std::span(snapshot.grains).subspan(first, layout.grains[n]);
}

bool IsIndex(int index, std::size_t size) { return index >= -1 && index < static_cast<int>(size); }

}  // namespace

std::size_t FrameLayout::Width(std::size_t track) const {
  if (track < bodies) return kBodyWidth;
  if (track < Joints()) return 3 * grains[track - bodies];
  if (track < FirstHand()) return 2 * joints;
  if (track < Gazes()) return kHandOwnWidth + hands[track - FirstHand()].links.size();
  return kGazeWidth * gazes;
}

FrameLayout LayoutOf(const physics::Scene& scene) {
  FrameLayout layout{.rate_hz = scene.world.rate_hz,
                     .bodies = scene.bodies.size(),
                     .grains = {},
                     .joints = scene.joints.size(),
                     .hands = {},
                     .gazes = scene.persons.size()};
  for (const physics::Body& body : scene.bodies) {
    if (body.grains) layout.grains.push_back(body.grains->p_WG_m.size());
  }
  for (const physics::Hand& hand : scene.hands) layout.hands.push_back(hand.model);
  return layout;
}

bool IsRigid(const FrameLayout& layout, std::size_t track) {
  return track < layout.bodies || (track >= layout.FirstHand() && track < layout.Gazes());
}

void ReadRow(const FrameLayout& layout, std::size_t track, const physics::Snapshot& snapshot,
             std::span<Word> row) {
  RowWriter out(row);
  if (track < layout.bodies) {
    PutMotion(snapshot.bodies[track], out);
    out.PutInteger(snapshot.bodies[track].asleep ? 1 : 0);
  } else if (track < layout.Joints()) {
    std::size_t first = 0;
    for (std::size_t i = 0; i < track - layout.bodies; ++i) first += layout.grains[i];
    for (std::size_t i = 0; i < layout.grains[track - layout.bodies]; ++i)
      out.Put(snapshot.grains[first + i]);
  } else if (track < layout.FirstHand()) {
    for (const physics::JointState& joint : snapshot.joints) {
      out.Put(joint.position);
      out.Put(joint.fraction);
    }
  } else if (track < layout.Gazes()) {
    PutHand(snapshot.hands[track - layout.FirstHand()], out);
  } else {
    for (const physics::GazeState& gaze : snapshot.gazes) PutGaze(gaze, out);
  }
}

void WriteRow(const FrameLayout& layout, std::size_t track, const Columns& columns, std::size_t row,
              physics::Snapshot& snapshot) {
  RowReader in(columns, row);
  if (track < layout.bodies) {
    TakeMotion(in, snapshot.bodies[track]);
    snapshot.bodies[track].asleep = in.Integer() != 0;
  } else if (track < layout.Joints()) {
    for (Eigen::Vector3d& grain : GrainsAt(layout, track - layout.bodies, snapshot)) in.Take(grain);
  } else if (track < layout.FirstHand()) {
    for (physics::JointState& joint : snapshot.joints) {
      joint.position = in.Double();
      joint.fraction = in.Double();
    }
  } else if (track < layout.Gazes()) {
    TakeHand(in, snapshot.hands[track - layout.FirstHand()]);
  } else {
    for (physics::GazeState& gaze : snapshot.gazes) TakeGaze(in, gaze);
  }
}

physics::Pose PoseInRow(const Columns& columns, std::size_t row) {
  RowReader in(columns, row);
  physics::Pose pose;
  in.Take(pose.p_m);
  in.Take(pose.q);
  return pose;
}

double JointInRow(const Columns& columns, std::size_t row, std::size_t link) {
  return std::bit_cast<double>(columns.At(row, kHandOwnWidth + link));
}

bool HasValidIndices(const FrameLayout& layout, const physics::Snapshot& snapshot) {
  for (std::size_t i = 0; i < layout.hands.size(); ++i) {
    const std::size_t styles = std::max<std::size_t>(layout.hands[i].styles.size(), 1);
    const int style = snapshot.hands[i].style;
    if (style < 0 || !IsIndex(style, styles)) return false;
  }
  return std::ranges::all_of(snapshot.gazes, [&](const physics::GazeState& gaze) {
    return IsIndex(gaze.body.number(), layout.bodies) &&
           IsIndex(gaze.hand.number(), layout.hands.size());
  });
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
