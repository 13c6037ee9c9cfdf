// SPDX-License-Identifier: Apache-2.0
// Where entities are to each other: inside, nearest, above. See grammar/engine/evaluate.h
#include <algorithm>
#include <limits>
#include <span>

#include "grammar/engine/evaluate.h"

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

bool Evaluator::IsInside(const Node& node, const View& view) const {
  const auto who = static_cast<std::size_t>(Entity(node, view, 0)),
             room = static_cast<std::size_t>(Entity(node, view, 1));
  const EntityInfo& of = entity_table_.entities[room];
  const EntitySample& look = history_.Look(static_cast<int>(who), view.frame);
  const EntitySample& at = history_.Look(static_cast<int>(room), view.frame);
  const Vector3d centre_W = look.p_WB_m + look.q_WB * entity_table_.entities[who].p_BC_m;
  const Vector3d away_m = at.q_WB.conjugate() * (centre_W - at.p_WB_m) - of.p_BC_m;
  if (of.round) return away_m.norm() <= of.half_size_m.x();
  return (away_m.cwiseAbs().array() <= of.half_size_m.array()).all();
}

double Evaluator::AwayFrom_m(int who, int whom, FrameNumber frame) const {
  return DistanceToSurface_m(history_.Look(whom, frame).p_WB_m,
                             entity_table_.entities[static_cast<std::size_t>(who)],
                             history_.Look(who, frame));
}

// Others of the class move, too, and nobody watches them. Of two that are equally near, the first
// in the cast is.
bool Evaluator::IsNearest(const Node& node, const View& view) const {
  depends_on_time_ = true;
  const int who = Entity(node, view, 0);
  const int whom = Entity(node, view, 1);
  const std::string& of_class =
      program_.rules[view.instance.rule].roles[static_cast<std::size_t>(node.roles[0])].class_name;
  const auto away_m = [&](int entity) { return AwayFrom_m(entity, whom, view.frame); };
  const double here_m = away_m(who);
  for (int other = 0; other < static_cast<int>(entity_table_.entities.size()); ++other) {
    if (other == who || other == whom || !instances_.IsA(other, of_class)) continue;
    if (!IsTracked(other, view.frame)) continue;
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

// The top of a part is the side of its own box that looks up most. Of the parts of b below which or
// above which a is, the one counts whose top is nearest to a's lowest point.
double Evaluator::Clearance_m(int a, int b, FrameNumber frame) const {
  if (!IsTracked(a, frame) || !IsTracked(b, frame)) return std::numeric_limits<double>::quiet_NaN();
  SolidPart box_a, box_b;
  const auto upper = PartsOf(entity_table_.entities[static_cast<std::size_t>(a)], box_a);
  const auto lower = PartsOf(entity_table_.entities[static_cast<std::size_t>(b)], box_b);
  const EntitySample& at = history_.Look(a, frame);
  const EntitySample& on = history_.Look(b, frame);
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const SolidPart& part : lower) {
    const Eigen::Quaterniond q_WS = on.q_WB * part.q_BS;
    const Vector3d p_WS_m = on.p_WB_m + on.q_WB * part.p_BS_m;
    const Vector3d up = q_WS.conjugate() * Vector3d::UnitZ();
    Eigen::Index top = 0;
    up.cwiseAbs().maxCoeff(&top);
    double above_m = 0;
    bool overlap = true;
    for (Eigen::Index axis = 0; axis < 3 && overlap; ++axis) {
      const double sign = up[axis] < 0 ? -1 : 1;
      const Vector3d n = Vector3d::Unit(axis) * sign;
      const Extent of_part = ExtentOf(part.shape, n);
      const Vector3d n_W = q_WS * n;
      Extent of_upper = ExtentOf(upper, at.q_WB.conjugate() * n_W);
      const double away_m = (at.p_WB_m - p_WS_m).dot(n_W);
      of_upper = {of_upper.low + away_m, of_upper.high + away_m};
      if (axis == top) {
        above_m = of_upper.low - of_part.high;
      } else {
        overlap = of_upper.low < of_part.high && of_upper.high > of_part.low;
      }
    }
    if (overlap && std::abs(above_m) < std::abs(nearest_m)) nearest_m = above_m;
  }
  return nearest_m;
}

}  // namespace prehend::grammar
