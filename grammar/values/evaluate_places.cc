// SPDX-License-Identifier: Apache-2.0
// Where entities are to each other: inside, nearest, above. See grammar/values/evaluate.h
#include <algorithm>
#include <limits>
#include <span>

#include "grammar/values/evaluate.h"

namespace prehend::grammar {

using Eigen::Vector3d;

// From a point in the world to the surface of an entity, at most `most_m`; 0 inside.
double DistanceToSurface_m(const Vector3d& p_W, const EntityInfo& member, const EntitySample& look,
                           double most_m) {
  const Vector3d p_B = look.q_WB.conjugate() * (p_W - look.p_WB_m);
  if (!member.solid.IsEmpty()) return member.solid.DistanceTo(p_B, most_m);
  const Vector3d outside = ((p_B - member.p_BC_m).cwiseAbs() - member.half_size_m).cwiseMax(0);
  return outside.norm();
}

namespace {

/// Neither the longest nor the shortest one, as the width of a bottle and of a bowl.
double MiddleEdge(const Vector3d& edges) {
  return edges.sum() - edges.maxCoeff() - edges.minCoeff();
}

}  // namespace

// Of two things that have each other's centre, one is round the other, as a cup is round a bottle:
// the wider one, however they are turned; of equals, as of nested cups, the lower one.
bool Evaluator::IsInside(const Node& node, const View& view) const {
  const int who = Entity(node, view, 0), room = Entity(node, view, 1);
  if (OutOfBox_m(who, room, view.frame) > 0) return false;
  if (OutOfBox_m(room, who, view.frame) > 0 || !instances_.IsA(who, "Thing") ||
      !instances_.IsA(room, "Thing"))
    return true;
  const auto edge = [&](int of) {
    return MiddleEdge(entity_table_.entities[static_cast<std::size_t>(of)].half_size_m);
  };
  if (edge(who) != edge(room)) return edge(who) < edge(room);
  return history_.Look(who, view.frame).p_WB_m.z() > history_.Look(room, view.frame).p_WB_m.z();
}

double Evaluator::AwayFrom_m(int who, int whom, FrameNumber frame) const {
  if (!IsTracked(who, frame) || !IsTracked(whom, frame))
    return std::numeric_limits<double>::quiet_NaN();
  return ToSurface_m(history_.Look(whom, frame).p_WB_m, who, frame);
}

double Evaluator::ToSurface_m(const Vector3d& p_W, int entity, FrameNumber frame) const {
  const HandAtFrame* hand = history_.Hand(entity, frame);
  if (hand == nullptr)
    return DistanceToSurface_m(p_W, entity_table_.entities[static_cast<std::size_t>(entity)],
                               history_.Look(entity, frame));
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const CollisionSphere& sphere : hand->collision_spheres)
    nearest_m = std::min(nearest_m, (p_W - sphere.p_W_m).norm() - sphere.radius_m);
  return std::max(nearest_m, 0.0);
}

// Others of the class move, too, and nobody watches them. Of two that are equally near, the first
// in the cast is.
bool Evaluator::IsNearest(const Node& node, const View& view) const {
  const int who = Entity(node, view, 0);
  const int whom = Entity(node, view, 1);
  const std::string& of_class =
      program_.rules[view.instance.rule].roles[static_cast<std::size_t>(node.roles[0])].class_name;
  const auto away_m = [&](int entity) { return AwayFrom_m(entity, whom, view.frame); };
  const double here_m = away_m(who);
  for (int other = 0; other < static_cast<int>(entity_table_.entities.size()); ++other) {
    if (other == who || other == whom || !instances_.IsA(other, of_class)) continue;
    const double there_m = away_m(other);
    if (there_m < here_m || (there_m == here_m && other < who)) return false;
  }
  return true;
}

namespace {

struct Extent {
  double low = 0;
  double high = 0;
};

// Of a shape in its own frame, along a direction of length 1.
Extent ExtentOf(const Shape& shape, const Vector3d& n) {
  const auto symmetric = [](double half) { return Extent{-half, half}; };
  const double across = n.head<2>().norm();
  if (const auto* box = std::get_if<Box>(&shape))
    return symmetric(n.cwiseAbs().dot(box->half_size_m));
  if (const auto* ball = std::get_if<Ball>(&shape)) return symmetric(ball->radius_m);
  if (const auto* cylinder = std::get_if<Cylinder>(&shape))
    return symmetric(across * cylinder->radius_m + std::abs(n.z()) * cylinder->half_length_m);
  if (const auto* capsule = std::get_if<Capsule>(&shape))
    return symmetric(capsule->radius_m + std::abs(n.z()) * capsule->half_length_m);
  const std::vector<Vector3d>& points = std::get<Hull>(shape).points_m;
  Extent extent{points.front().dot(n), points.front().dot(n)};
  for (const Vector3d& point : points) {
    extent.low = std::min(extent.low, point.dot(n));
    extent.high = std::max(extent.high, point.dot(n));
  }
  return extent;
}

// Its bounding box, put into `box`, where that is all that is known.
std::span<const SolidPart> PartsOf(const EntityInfo& entity, SolidPart& box) {
  if (!entity.solid.IsEmpty()) return entity.solid.parts();
  box = {.shape = Box{entity.half_size_m}, .p_BS_m = entity.p_BC_m};
  return {&box, 1};
}

// Of all parts of an entity in its frame, along a direction of length 1.
Extent ExtentOf(std::span<const SolidPart> parts, const Vector3d& n) {
  Extent all{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const SolidPart& part : parts) {
    const Extent of_part = ExtentOf(part.shape, part.q_BS.conjugate() * n);
    all.low = std::min(all.low, part.p_BS_m.dot(n) + of_part.low);
    all.high = std::max(all.high, part.p_BS_m.dot(n) + of_part.high);
  }
  return all;
}

}  // namespace

double BoundOf_m(const EntityInfo& entity) {
  SolidPart box;
  const auto parts = PartsOf(entity, box);
  Vector3d corner_m;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Extent extent = ExtentOf(parts, Vector3d::Unit(axis));
    corner_m[axis] = std::max({std::abs(extent.low), std::abs(extent.high),
                               std::abs(entity.p_BC_m[axis]) + entity.half_size_m[axis]});
  }
  return corner_m.norm();
}

namespace {

struct HowOver {
  double above_m = 0;
  double beside_m = 0;
  double up = 0;
};

HowOver Over(const EntitySample& at, std::span<const SolidPart> upper, const EntitySample& on,
             const SolidPart& part) {
  const Eigen::Quaterniond q_WS = on.q_WB * part.q_BS;
  const Vector3d p_WS_m = on.p_WB_m + on.q_WB * part.p_BS_m;
  const Vector3d up = q_WS.conjugate() * Vector3d::UnitZ();
  Eigen::Index top = 0;
  HowOver over{.beside_m = -std::numeric_limits<double>::infinity()};
  over.up = up.cwiseAbs().maxCoeff(&top);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double sign = up[axis] < 0 ? -1 : 1;
    const Vector3d n = Vector3d::Unit(axis) * sign;
    const Extent of_part = ExtentOf(part.shape, n);
    const Vector3d n_W = q_WS * n;
    Extent of_upper = ExtentOf(upper, at.q_WB.conjugate() * n_W);
    const double away_m = (at.p_WB_m - p_WS_m).dot(n_W);
    of_upper = {of_upper.low + away_m, of_upper.high + away_m};
    if (axis == top) {
      over.above_m = of_upper.low - of_part.high;
    } else {
      over.beside_m =
          std::max({over.beside_m, of_upper.low - of_part.high, of_part.low - of_upper.high});
    }
  }
  return over;
}

}  // namespace

// Several rules ask for it.
const std::vector<Evaluator::OverPart>& Evaluator::OverParts(int a, int b,
                                                             FrameNumber frame) const {
  if (last_over_.empty()) last_over_.resize(kLastOver);
  const auto place = static_cast<std::size_t>(frame) + 31 * static_cast<std::size_t>(a) +
                     7 * static_cast<std::size_t>(b);
  LastOver& last = last_over_[place % kLastOver];
  if (last.frame == frame && last.a == a && last.b == b) return last.parts;
  last.frame = frame;
  last.a = a;
  last.b = b;
  last.parts.clear();
  SolidPart box_a, box_b;
  const auto upper = PartsOf(entity_table_.entities[static_cast<std::size_t>(a)], box_a);
  const auto lower = PartsOf(entity_table_.entities[static_cast<std::size_t>(b)], box_b);
  for (const SolidPart& part : lower) {
    const HowOver over = Over(history_.Look(a, frame), upper, history_.Look(b, frame), part);
    last.parts.push_back({over.above_m, over.beside_m, over.up});
  }
  return last.parts;
}

// The top of a part is the side of its own box that looks up most. Of the parts of b below which or
// above which a is, the one counts whose top is nearest to a's lowest point.
double Evaluator::Clearance_m(int a, int b, FrameNumber frame) const {
  if (!IsTracked(a, frame) || !IsTracked(b, frame)) return std::numeric_limits<double>::quiet_NaN();
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const OverPart& over : OverParts(a, b, frame)) {
    if (over.beside_m < 0 && std::abs(over.above_m) < std::abs(nearest_m)) nearest_m = over.above_m;
  }
  return nearest_m;
}

namespace {

constexpr double kSafe_m = 1e-5;  // more than all rounding, of ways that were added for days, too

bool IsAbsoluteClearance(const Program& program, const Node& node) {
  return node.op == Op::kAbs && program.nodes[node.args[0]].op == Op::kClearance;
}

bool AreOrigins(const Program& program, NodeId a, NodeId b) {
  return program.nodes[a].op == Op::kPosition && program.nodes[b].op == Op::kPosition;
}

bool IsAtMost(const Node& node) { return node.op == Op::kLess || node.op == Op::kLessEqual; }

}  // namespace

bool Evaluator::NeedsNearness(NodeId index) const {
  const Node& node = program_.nodes[index];
  const auto is_number = [&](NodeId arg) { return program_.nodes[arg].op == Op::kNumber; };
  if (node.op == Op::kAnd) return NeedsNearness(node.args[0]) || NeedsNearness(node.args[1]);
  if (node.op == Op::kOr) return NeedsNearness(node.args[0]) && NeedsNearness(node.args[1]);
  if (node.op == Op::kInside) return true;
  if (node.op == Op::kSolidInSphere)
    return program_.nodes[node.args[0]].op == Op::kPosition && is_number(node.args[1]);
  if (node.op == Op::kInSphere)
    return AreOrigins(program_, node.args[0], node.args[1]) && is_number(node.args[2]);
  if (!IsAtMost(node) || !is_number(node.args[1])) return false;
  const Node& value = program_.nodes[node.args[0]];
  return IsAbsoluteClearance(program_, value) || value.op == Op::kGap ||
         (value.op == Op::kDistance && AreOrigins(program_, value.args[0], value.args[1]));
}

double Evaluator::FalseFor_m(NodeId index, RuleInstance& instance, FrameNumber frame) const {
  if (!NeedsNearness(index)) return 0;
  const Node& node = program_.nodes[index];
  if (node.op == Op::kAnd || node.op == Op::kOr) {
    const double left_m = FalseFor_m(node.args[0], instance, frame);
    if (node.op == Op::kOr && left_m == 0) return 0;
    const double right_m = FalseFor_m(node.args[1], instance, frame);
    return node.op == Op::kAnd ? std::max(left_m, right_m) : std::min(left_m, right_m);
  }
  const double away_m = OutOfReach_m(node, instance, frame) - kSafe_m;
  return away_m > 0 ? away_m : 0;  // nor if it is no number
}

// Of a single test. The distance of two points, or of a point and a body, changes by no more than
// these move.
double Evaluator::OutOfReach_m(const Node& node, RuleInstance& instance, FrameNumber frame) const {
  const View view{instance, frame};
  for (std::size_t role = 0; role < program_.rules[instance.rule].roles.size(); ++role) {
    if (!IsTracked(instance.entities[role], frame)) return 0;
  }
  const auto number = [&](NodeId arg) { return program_.nodes[arg].number; };
  const auto origin = [&](NodeId arg) -> const Vector3d& {
    return history_.Look(Entity(program_.nodes[arg], view, 0), frame).p_WB_m;
  };
  if (node.op == Op::kInside)
    return OutOfBox_m(Entity(node, view, 0), Entity(node, view, 1), frame);
  if (node.op == Op::kSolidInSphere) {
    return ToSurface_m(origin(node.args[0]), Entity(node, view, 0), frame) - number(node.args[1]);
  }
  if (node.op == Op::kInSphere)
    return (origin(node.args[0]) - origin(node.args[1])).norm() - number(node.args[2]);
  const Node& value = program_.nodes[node.args[0]];
  const double most_m = number(node.args[1]);
  if (value.op == Op::kDistance)
    return (origin(value.args[0]) - origin(value.args[1])).norm() - most_m;
  if (value.op == Op::kGap)  // a hand without a surface may get one
    return std::min(Gap(Entity(value, view, 0), Entity(value, view, 1), frame), 100.0) - most_m;
  const Node& clearance = program_.nodes[value.args[0]];
  return OffTop_m(Entity(clearance, view, 0), Entity(clearance, view, 1), most_m, frame);
}

// How far the centre of a is from the box of b.
double Evaluator::OutOfBox_m(int a, int b, FrameNumber frame) const {
  const EntityInfo& box = entity_table_.entities[static_cast<std::size_t>(b)];
  const EntitySample& look = history_.Look(a, frame);
  const EntitySample& at = history_.Look(b, frame);
  const Vector3d centre_W =
      look.p_WB_m + look.q_WB * entity_table_.entities[static_cast<std::size_t>(a)].p_BC_m;
  const Vector3d away_m = at.q_WB.conjugate() * (centre_W - at.p_WB_m) - box.p_BC_m;
  if (box.round) return away_m.norm() - box.half_size_m.x();
  return (away_m.cwiseAbs() - box.half_size_m).cwiseMax(0).norm();
}

// What is measured along axes of b turns with it: what is so far away moves by that times the
// angle. No other side of b becomes its top while it stands nearly upright and turns by less than
// `kTurn_rad`.
double Evaluator::AlongAxes_m(int a, int b, double away_m, FrameNumber frame) const {
  constexpr double kTurn_rad = 0.2, kMore = 1.1;
  const Vector3d between_m = history_.Look(a, frame).p_WB_m - history_.Look(b, frame).p_WB_m;
  const double far_m =
      between_m.norm() + history_.Bound_m(a) + history_.Bound_m(b) + std::abs(away_m);
  return std::min(away_m * History::kArm_m / (History::kArm_m + kMore * far_m),
                  kTurn_rad * History::kArm_m / kMore);
}

namespace {

constexpr double kNearlyUp = 0.9;

}  // namespace

// How far a and b may move until a's clearance above b may be at most `most_m`. Beside b it is
// endless.
double Evaluator::OffTop_m(int a, int b, double most_m, FrameNumber frame) const {
  double away_m = std::numeric_limits<double>::infinity();
  for (const OverPart& over : OverParts(a, b, frame)) {
    if (!(over.up > kNearlyUp)) return 0;
    away_m = std::min(away_m, std::max(over.beside_m, std::abs(over.above_m) - most_m));
  }
  return AlongAxes_m(a, b, away_m, frame);
}

// Until it may be more: as long as a is below or above one part of b, and near its top.
double Evaluator::OnTop_m(int a, int b, double most_m, FrameNumber frame) const {
  double left_m = -1;
  for (const OverPart& over : OverParts(a, b, frame)) {
    if (over.up > kNearlyUp)
      left_m = std::max(left_m, std::min(-over.beside_m, most_m - std::abs(over.above_m)));
  }
  return left_m > 0 ? AlongAxes_m(a, b, left_m, frame) : 0;
}

double Evaluator::TrueFor_m(NodeId index, RuleInstance& instance, FrameNumber frame) const {
  const Node& node = program_.nodes[index];
  if (node.op == Op::kAnd || node.op == Op::kOr) {
    const double left_m = TrueFor_m(node.args[0], instance, frame);
    if (node.op == Op::kAnd && left_m == 0) return 0;
    const double right_m = TrueFor_m(node.args[1], instance, frame);
    return node.op == Op::kAnd ? std::min(left_m, right_m) : std::max(left_m, right_m);
  }
  if (!IsAtMost(node) || !NeedsNearness(index)) return 0;
  for (std::size_t role = 0; role < program_.rules[instance.rule].roles.size(); ++role) {
    if (!IsTracked(instance.entities[role], frame)) return 0;
  }
  const View view{instance, frame};
  const Node& value = program_.nodes[node.args[0]];
  const double most_m = program_.nodes[node.args[1]].number;
  double left_m = 0;
  if (value.op == Op::kDistance) {
    const std::optional<double> distance_m = Compute(value, view);
    left_m = distance_m ? most_m - *distance_m : 0;
  } else if (value.op != Op::kGap) {  // which is 0 before a hand is shown
    const Node& clearance = program_.nodes[value.args[0]];
    left_m = OnTop_m(Entity(clearance, view, 0), Entity(clearance, view, 1), most_m, frame);
  }
  left_m -= kSafe_m;
  return left_m > 0 ? left_m : 0;  // nor if it is no number
}

}  // namespace prehend::grammar
