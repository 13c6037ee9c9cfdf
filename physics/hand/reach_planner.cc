// SPDX-License-Identifier: Apache-2.0
// Candidates are scored in radians: turns of the hand, and penalties for grips of last resort.
#include "physics/hand/reach_planner.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "physics/hand/hand_clearance.h"
#include "physics/scene/geometry.h"
#include "physics/scene/joint.h"

namespace prehend::physics {
namespace {

constexpr double kPi = std::numbers::pi;
/// Approach::kAuto takes an object from the side if it is at least this high and this many times as
/// high as wide.
constexpr double kTall_m = 0.09;
constexpr double kSlender = 1.25;
/// A path with this clearance is accepted.
constexpr double kClearEnough_m = 0.002;
constexpr double kRounding_m = 1e-9;
/// Share of a reach after which the orientation has settled, well before the fingers enclose the
/// object.
constexpr double kTurnShare = 0.75;
/// Number of orientations tried around a round object.
constexpr int kRoundDirections = 24;
/// Cost, in radians, of a grip that is wider than the hand opens: a last resort.
constexpr double kTooWide = 100;

/// Cost, in radians, of a hand rotated by a right angle about its approach: for objects that cannot
/// be gripped upright.
constexpr double kRolled = 20;

/// Share of a turn that counts if another candidate turns as much the other way round: then the
/// hand turns inward, a right hand to the left.
constexpr double kInward = 1e-6;
/// Cost of rolling the hand the other way, which may otherwise be equal but for rounding.
constexpr double kOtherRoll = 1e-6;

/// Bends of the path, in the order in which they are tried: how long the last part follows the
/// direction of arrival, and how much the path rises first.
struct Bend {
  double straight_m;
  double rise_m;
};
constexpr Bend kBends[] = {{0.10, 0},    {0.16, 0},    {0.16, 0.10},
                           {0.24, 0.10}, {0.24, 0.25}, {0.35, 0.35}};

struct Candidate {
  Pose X_WH;
  Eigen::Vector3d toward_W;
  double cost = 0;
  double beside_m =
      0;  ///< distance of the grip from the point to grasp, other than along the grip axis
  double too_wide_m = 0;  ///< width of the object's box along the grip axis minus opening, if > 0
  double width_m = 0;     ///< of the object itself along the grip axis
};

/// The rotation that takes the orthonormal pair (a_H, b_H) to (a_W, b_W).
Eigen::Quaterniond RotationFromPairs(const Eigen::Vector3d& a_H, const Eigen::Vector3d& b_H,
                                     const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W) {
  Eigen::Matrix3d H, W;
  H << a_H, b_H, a_H.cross(b_H);
  W << a_W, b_W, a_W.cross(b_W);
  return Eigen::Quaterniond(Eigen::Matrix3d(W * H.transpose())).normalized();
}

/// `to`; but rounding would decide which way round a turn of half a circle goes. So it ends a hair
/// farther if it is not inward, or, about a level axis, not about +y, +x or +z of the hand: then
/// the other way is shorter. `side` is -1 of a left hand, else 1.
Eigen::Quaterniond InwardHalfTurn(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to,
                                  int side) {
  constexpr double kHair = 1e-6;
  const Eigen::Vector3d turn_W = RotationVector(to * from.conjugate());
  if (turn_W.norm() < kPi - kHair) return to;
  const Eigen::Vector3d turn_H = from.conjugate() * turn_W;
  for (const double way : {side * turn_W.z(), turn_H.y(), side * turn_H.x(), side * turn_H.z()}) {
    if (std::abs(way) < kHair) continue;
    if (way > 0) break;
    return Eigen::Quaterniond(Eigen::AngleAxisd(2 * kHair, turn_W.normalized())) * to;
  }
  return to;
}

Eigen::Vector3d Horizontal(double yaw_rad) { return {std::cos(yaw_rad), std::sin(yaw_rad), 0}; }

double YawOf(const Eigen::Vector3d& v) { return std::atan2(v.y(), v.x()); }

/// Horizontal directions in which the object may be gripped or approached: normals of its faces, or
/// all around; in a planar scene the two directions along the plane. For a left hand they are the
/// mirror image, to the last bit and in their order, of those of a right one (`side` -1, else 1).
std::vector<double> YawsOf(const Body& body, const Pose& X_WB, double hand_yaw_rad, bool planar,
                           int side) {
  if (planar) return {0, kPi};
  std::vector<double> yaws;
  const auto add = [&](double first_yaw, double further) {
    yaws.push_back(side * (side * first_yaw + further));
  };
  if (IsRoundAboutVertical(body, X_WB)) {
    for (int i = 0; i < kRoundDirections; ++i) add(hand_yaw_rad, 2 * kPi * i / kRoundDirections);
    return yaws;
  }
  const Eigen::Vector3d x = X_WB.q * Eigen::Vector3d::UnitX(),
                        y = X_WB.q * Eigen::Vector3d(0, side, 0);
  const double face_yaw = std::abs(x.z()) < std::abs(y.z()) ? YawOf(x) : YawOf(y);
  for (int i = 0; i < 4; ++i) add(face_yaw, kPi / 2 * i);
  return yaws;
}

/// What the hand has to enclose: a whole body at its centre, or a part of a body at a point.
struct Target {
  Target(const Body& whole, const Pose& X_WWhole, const std::optional<Eigen::Vector3d>& point_m)
      : body(whole), X_WB(X_WWhole) {
    if (point_m) {
      const PlacedShape& part = PartAt(whole, *point_m);
      body.shapes = {{part.shape, {}}};
      X_WB = X_WWhole * part.X_BS;
    }
    box = BoundingBox(body);
    centre_W_m = X_WB * box.p_BC_m;
    point_W_m = point_m ? X_WWhole * *point_m : centre_W_m;
  }

  Body body;
  Pose X_WB;
  LocalBox box;
  Eigen::Vector3d centre_W_m;
  Eigen::Vector3d point_W_m;
};

/// Heights above which palm and fingers have to stay.
class Ground {
 public:
  Ground(const Scene& scene, const Snapshot& now, BodyIndex object)
      : object_(BoundsOf(scene, now, object)) {
    constexpr double kInside_m = 0.01;  // a foot this much narrower does not obstruct
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      const Body& body = scene.bodies[i];
      if (!IsThing(body) || RootOf(scene, BodyIndex(i)) == RootOf(scene, object)) continue;
      for (const PlacedShape& placed : body.shapes) {
        const Eigen::AlignedBox3d bounds =
            WorldBounds(placed.shape, now.bodies[i].X_WB * placed.X_BS);
        const bool is_foot = (bounds.min() - object_.min()).head<2>().minCoeff() > kInside_m &&
                             (object_.max() - bounds.max()).head<2>().minCoeff() > kInside_m;
        if (bounds.max().z() <= object_.min().z() + kRests_m && !is_foot) below_.push_back(bounds);
      }
    }
  }

  /// Height of the highest surface that is below the object and under a box of these half sizes
  /// around a point; the object's lowest point if the object rests on that surface. Far down if
  /// there is nothing.
  double Under(const Eigen::Vector3d& p_W_m, const Eigen::Vector3d& half_size_m) const {
    double highest_m = -std::numeric_limits<double>::infinity();
    for (const Eigen::AlignedBox3d& bounds : below_) {
      const Eigen::Vector3d beside_m =
          (bounds.min() - p_W_m).cwiseMax(p_W_m - bounds.max()) - half_size_m;
      if (beside_m.head<2>().maxCoeff() < 0) highest_m = std::max(highest_m, bounds.max().z());
    }
    const double lowest_m = object_.min().z();
    return highest_m > lowest_m - kRests_m ? lowest_m : highest_m;
  }

 private:
  static constexpr double kRests_m = 0.005;
  static Eigen::AlignedBox3d BoundsOf(const Scene& scene, const Snapshot& now, BodyIndex body) {
    return WorldBounds(scene.body(body), now.body(body).X_WB);
  }

  Eigen::AlignedBox3d object_;
  std::vector<Eigen::AlignedBox3d> below_;
};

class CandidateList {
 public:
  CandidateList(const Scene& scene, const Snapshot& now, const ReachQuery& query)
      : query_(query),
        planar_(scene.world.planar),
        hand_(scene.hand(query.hand).model),
        style_(hand_.styles[static_cast<std::size_t>(query.style)]),
        side_(hand_.left ? -1 : 1),
        target_(scene.body(query.object), now.body(query.object).X_WB, query.point_m),
        ground_(scene, now, query.object),
        mounted_(JointThatMoves(scene, query.object) >= 0) {}

  std::vector<Candidate> FromAbove() const;
  std::vector<Candidate> FromSide() const;
  bool SideIsNatural() const;

 private:
  Candidate Make(const GraspApproach& approach, const Eigen::Quaterniond& wanted) const;

  double HalfWidth(const Eigen::Vector3d& direction_W) const {
    return HalfWidthAlong(target_.box, target_.X_WB, direction_W);
  }

  const ReachQuery& query_;
  const bool planar_;
  const HandModel& hand_;
  const GraspStyle& style_;
  const int side_;  ///< -1 of a left hand, else 1
  const Target target_;
  const Ground ground_;
  const bool mounted_;  ///< held by a joint: not resting on a support
};

Candidate CandidateList::Make(const GraspApproach& approach,
                              const Eigen::Quaterniond& wanted) const {
  const Eigen::Quaterniond q = InwardHalfTurn(query_.from.X_WH.q, wanted, side_);
  const Eigen::Vector3d toward_W = q * approach.toward, grip_W = q * style_.grip_axis;
  const double half_grip = HalfWidth(grip_W);
  // The post is at the object's face: along the grip axis the middle counts, in the other
  // directions the point.
  const Eigen::Vector3d to_middle = target_.centre_W_m - target_.point_W_m;
  const Eigen::Vector3d point_W = target_.point_W_m + grip_W * grip_W.dot(to_middle);
  const double to_face = HalfWidth(toward_W) - toward_W.dot(to_middle);
  const double depth = std::max(approach.pads_m, approach.palm_gap_m + to_face);
  // In H: from the post along the grip axis to the object's middle, at the depth of the style.
  const Eigen::Vector3d on_post =
      style_.post_m - approach.toward * approach.toward.dot(style_.post_m);
  const Eigen::Vector3d centre_H = on_post + style_.grip_axis * half_grip + approach.toward * depth;

  Candidate candidate{.X_WH = {point_W - q * centre_H, q}, .toward_W = toward_W};
  // Space that palm and fingers need around the object.
  constexpr double kFinger_m = 0.03, kHalfPalm_m = 0.045;
  const Eigen::Vector3d half_size_m = grip_W.cwiseAbs() * (half_grip + kFinger_m) +
                                      toward_W.cwiseAbs() * kFinger_m +
                                      toward_W.cross(grip_W).cwiseAbs() * kHalfPalm_m;
  const double floor_W_m = ground_.Under(point_W, half_size_m) + approach.floor_m;
  const double raised_m = mounted_ ? 0 : std::max(0.0, floor_W_m - candidate.X_WH.p_m.z());
  candidate.X_WH.p_m.z() += raised_m;
  candidate.beside_m =
      (raised_m * Eigen::Vector3d::UnitZ() - (depth - approach.pads_m) * toward_W).norm();
  candidate.X_WH.p_m += query_.offset_m;
  const Eigen::Vector3d turn = RotationVector(q * query_.from.X_WH.q.conjugate());
  candidate.cost = turn.norm() - kInward * side_ * turn.z();
  candidate.too_wide_m = std::max(0.0, 2 * half_grip - style_.opening_m);
  if (candidate.too_wide_m > 0) candidate.cost += kTooWide;
  candidate.width_m = WidthAlong(target_.body, target_.X_WB, grip_W);
  return candidate;
}

std::vector<Candidate> CandidateList::FromAbove() const {
  std::vector<Candidate> candidates;
  if (!style_.above) return candidates;
  const double hand_yaw = YawOf(query_.from.X_WH.q * style_.grip_axis);
  for (const double yaw : YawsOf(target_.body, target_.X_WB, hand_yaw, planar_, side_)) {
    const Eigen::Quaterniond q = RotationFromPairs(style_.above->toward, style_.grip_axis,
                                                   -Eigen::Vector3d::UnitZ(), Horizontal(yaw));
    candidates.push_back(Make(*style_.above, q));
  }
  return candidates;
}

std::vector<Candidate> CandidateList::FromSide() const {
  std::vector<Candidate> candidates;
  if (!style_.side) return candidates;
  Eigen::Vector3d way = target_.point_W_m - query_.from.X_WH.p_m;
  way.z() = 0;
  const bool above_it = way.norm() < target_.box.half_size_m.minCoeff();
  const double half_height = HalfWidth(Eigen::Vector3d::UnitZ());
  const auto add = [&](const Eigen::Vector3d& toward_W, const Eigen::Vector3d& up_W, double cost) {
    const Eigen::Quaterniond q =
        RotationFromPairs(style_.side->toward, style_.side->up, toward_W, up_W);
    candidates.push_back(Make(*style_.side, q));
    candidates.back().cost += cost;
  };
  Eigen::Vector3d inwards = target_.centre_W_m - target_.point_W_m;
  inwards.z() = 0;
  const bool at_rim = inwards.norm() > kAtPoint_m;
  for (const double yaw :
       YawsOf(target_.body, target_.X_WB, YawOf(at_rim ? inwards : way), planar_, side_)) {
    const Eigen::Vector3d toward_W = Horizontal(yaw);
    const Eigen::Vector3d across_W = side_ * Eigen::Vector3d::UnitZ().cross(toward_W);
    // An approach from the far side has to go round the object.
    const double around =
        above_it ? 0 : std::acos(std::clamp(toward_W.dot(way.normalized()), -1.0, 1.0));
    add(toward_W, Eigen::Vector3d::UnitZ(), around);
    // An object that is lower than wide can also be gripped at its top and bottom.
    if (!planar_ && half_height >= HalfWidth(across_W)) continue;
    add(toward_W, across_W, around + kRolled);
    add(toward_W, -across_W, around + kRolled + kOtherRoll);
  }
  return candidates;
}

bool CandidateList::SideIsNatural() const {
  const double height_m = WorldBounds(target_.body, target_.X_WB).sizes().z();
  double width_m = height_m;
  for (const double yaw : YawsOf(target_.body, target_.X_WB, 0, planar_, side_))
    width_m = std::min(width_m, WidthAlong(target_.body, target_.X_WB, Horizontal(yaw)));
  return style_.side && height_m >= kTall_m && height_m >= kSlender * width_m;
}

/// Keeps the candidates that the hand can open for and that grasp the point; if there are none,
/// those nearest to the point.
void KeepNearest(std::vector<Candidate>& candidates) {
  const auto is_too_wide = [](const Candidate& candidate) { return candidate.too_wide_m > 0; };
  if (!std::ranges::all_of(candidates, is_too_wide)) std::erase_if(candidates, is_too_wide);
  if (candidates.empty()) return;
  const double nearest_m = std::ranges::min_element(candidates, {}, &Candidate::beside_m)->beside_m;
  constexpr double kAsNear_m = 0.001;
  const double most_m = std::max(kAtPoint_m, nearest_m + kAsNear_m);
  std::erase_if(candidates,
                [&](const Candidate& candidate) { return candidate.beside_m > most_m; });
}

std::vector<Candidate> Candidates(const Scene& scene, const Snapshot& now,
                                  const ReachQuery& query) {
  const CandidateList list(scene, now, query);
  std::vector<Candidate> above = list.FromAbove(), side = list.FromSide();
  if (scene.world.planar) {
    // In a planar scene a hand cannot turn over: its y axis does not change.
    const Eigen::Vector3d y_W = query.from.X_WH.q * Eigen::Vector3d::UnitY();
    const auto turned_over = [&](const Candidate& candidate) {
      return y_W.dot(candidate.X_WH.q * Eigen::Vector3d::UnitY()) < 0.5;
    };
    std::erase_if(above, turned_over);
    std::erase_if(side, turned_over);
  }
  const auto by_cost = [](const Candidate& l, const Candidate& r) { return l.cost < r.cost; };
  std::stable_sort(above.begin(), above.end(), by_cost);
  std::stable_sort(side.begin(), side.end(), by_cost);
  const bool side_first = query.approach == Approach::kSide ||
                          (query.approach == Approach::kAuto && list.SideIsNatural());
  std::vector<Candidate>& first = side_first ? side : above;
  std::vector<Candidate>& second = side_first ? above : side;
  // A requested approach is used if the style has it.
  if (query.approach == Approach::kAuto || first.empty())
    first.insert(first.end(), second.begin(), second.end());
  if (query.point_m) KeepNearest(first);
  return first;
}

Segment Way(const ReachQuery& query, const Candidate& to, const Bend& bend) {
  const Eigen::Vector3d begin = query.from.X_WH.p_m, end = to.X_WH.p_m;
  const Eigen::Vector3d before_end = end - to.toward_W * bend.straight_m;
  const Eigen::Vector3d after_begin = (begin + before_end) / 2 + Eigen::Vector3d(0, 0, bend.rise_m);
  return {.duration_s = query.over_s,
          .curve_m = {begin, after_begin, before_end, end},
          .q_begin = query.from.X_WH.q,
          .q_end = to.X_WH.q,
          .turn_share = kTurnShare,
          .trigger_begin = query.from.trigger,
          .trigger_end = query.from.trigger};
}

}  // namespace

ReachPlan PlanReach(const Scene& scene, const Snapshot& now, const ReachQuery& query) {
  const HandModel& model = scene.hand(query.hand).model;
  const GraspStyle& style = model.styles[static_cast<std::size_t>(query.style)];
  const HandClearance clearance(scene, query.hand, JointTargets(style, query.from.trigger));
  ReachPlan best;
  bool have_one = false;
  for (const Candidate& candidate : Candidates(scene, now, query)) {
    // A requested offset may lead into the object: it may reduce the clearance by its length.
    const double at_end_m = clearance.At(candidate.X_WH, now);
    const bool fits =
        at_end_m >= kClearEnough_m - query.offset_m.norm() && candidate.too_wide_m == 0;
    // The last look is at the end, but for rounding.
    const double clear_enough_m = std::min(kClearEnough_m, at_end_m - kRounding_m);
    for (const Bend& bend : kBends) {
      ReachPlan plan{.segment = Way(query, candidate, bend),
                     .toward_W = candidate.toward_W,
                     .beside_m = query.point_m ? candidate.beside_m : 0,
                     .width_m = candidate.width_m};
      plan.clearance_m = clearance.Along(plan.segment, now);
      plan.found = fits && plan.clearance_m >= clear_enough_m;
      if (plan.found) return plan;
      if (!have_one || plan.clearance_m > best.clearance_m + kRounding_m) best = plan;
      have_one = true;
    }
  }
  return best;
}

}  // namespace prehend::physics
