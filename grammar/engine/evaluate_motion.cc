// SPDX-License-Identifier: Apache-2.0
// Signals of motion against another entity, and over a window of time.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "grammar/engine/evaluate.h"

namespace prehend::grammar {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector3d InFrameOf(const EntitySample& look, const Vector3d& p_W_m) {
  return look.q_WB.conjugate() * (p_W_m - look.p_WB_m);
}

// What is left of a way or a velocity in the plane across the normal.
Vector3d Along(const Vector3d& v, const Vector3d& nhat) { return v - v.dot(nhat) * nhat; }

}  // namespace

// From the last frame that is half the window earlier to the first one that is half the window
// later; at the episode's begin and end it is cut off. Nothing while the later frame is still to
// come.
std::optional<Evaluator::Window> Evaluator::WindowAround(FrameNumber frame, double seconds) const {
  depends_on_time_ = true;
  const Tick now = history_.At(frame).tick;
  const Tick half = history_.AtLeastTicks(seconds / 2);
  const Window window{history_.LastNotAfter(now - half),
                      std::min(history_.FirstNotBefore(now + half), history_.now())};
  if (history_.At(window.late).tick < now + half && !history_.complete()) return std::nullopt;
  return window;
}

double Evaluator::SecondsBetween(FrameNumber early, FrameNumber late) const {
  return history_.Seconds(history_.At(late).tick - history_.At(early).tick);
}

std::optional<double> Evaluator::Rate(const Node& node, const View& view) const {
  const std::optional<Window> window = WindowAround(view.frame, node.number);
  if (!window) return std::nullopt;
  if (window->early == window->late) return 0;
  const std::optional<double> before = Number(node.args[0], view.At(window->early));
  const std::optional<double> after = Number(node.args[0], view.At(window->late));
  if (!before || !after) return std::nullopt;
  return (*after - *before) / SecondsBetween(window->early, window->late);
}

// In the world, or as seen from a second entity.
std::optional<double> Evaluator::SpeedOver(const Node& node, const View& view) const {
  const std::optional<Window> window = WindowAround(view.frame, node.number);
  if (!window) return std::nullopt;
  if (window->early == window->late) return 0;
  const int a = Entity(node, view, 0);
  const auto place = [&](FrameNumber frame) -> Vector3d {
    return node.op == Op::kSpeedOver ? history_.Look(a, frame).p_WB_m
                                     : PositionOn(a, Entity(node, view, 1), frame);
  };
  return (place(window->late) - place(window->early)).norm() /
         SecondsBetween(window->early, window->late);
}

namespace {

double OfValues(Op op, std::vector<double>& values) {
  switch (op) {
    case Op::kMean:
      return std::accumulate(values.begin(), values.end(), 0.0) /
             static_cast<double>(values.size());
    case Op::kMinimum:
      return *std::ranges::min_element(values);
    case Op::kMaximum:
      return *std::ranges::max_element(values);
    default: {
      const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
      std::nth_element(values.begin(), middle, values.end());
      return *middle;
    }
  }
}

}  // namespace

// Of the values at the frames at most half the window before or after. Nothing while one of them
// may still come.
std::optional<double> Evaluator::OfWindow(const Node& node, const View& view) const {
  depends_on_time_ = true;
  const Tick now = history_.At(view.frame).tick;
  const Tick half = history_.AtMostTicks(node.number / 2);
  if (history_.At(history_.now()).tick < now + half && !history_.complete()) return std::nullopt;
  const FrameNumber last = std::min(history_.LastNotAfter(now + half), history_.now());
  std::vector<double> values = std::exchange(window_values_, {});  // a window may be in a window
  values.clear();
  std::optional<double> value = 0;
  for (FrameNumber frame = history_.FirstNotBefore(now - half);
       frame <= last && value && !std::isnan(*value); ++frame) {
    value = Number(node.args[0], view.At(frame));
    if (value) values.push_back(*value);
  }
  if (value && !std::isnan(*value)) value = OfValues(node.op, values);
  window_values_ = std::move(values);
  return value;
}

// The way of a as seen from b between two frames, turned to where b is now, without its upright
// part.
Vector2d Evaluator::WayOn(const Node& node, const View& view, FrameNumber early,
                          FrameNumber late) const {
  const int a = Entity(node, view, 0);
  const int b = Entity(node, view, 1);
  const Vector3d way_W =
      history_.Look(b, view.frame).q_WB * (PositionOn(a, b, late) - PositionOn(a, b, early));
  return way_W.head<2>();
}

std::optional<double> Evaluator::DriftAlong(const Node& node, const View& view) const {
  const std::optional<Window> window = WindowAround(view.frame, node.number);
  if (!window) return std::nullopt;
  if (window->early == window->late) return 0;
  const TouchPlace touch = TouchPlaceOf(node, view);
  const auto look = [&](int role, FrameNumber frame) -> const EntitySample& {
    return history_.Look(Entity(node, view, role), frame);
  };
  const Vector3d piece_A = InFrameOf(look(0, view.frame), touch.p_W_m);
  const auto place_B = [&](FrameNumber frame) {
    const EntitySample& a = look(0, frame);
    return InFrameOf(look(1, frame), a.p_WB_m + a.q_WB * piece_A);
  };
  const Vector3d nhat_B = look(1, view.frame).q_WB.conjugate() * touch.nhat_W;
  return Along(place_B(window->late) - place_B(window->early), nhat_B).norm() /
         SecondsBetween(window->early, window->late);
}

double Evaluator::SpeedAlong(const Node& node, const View& view) const {
  const TouchPlace touch = TouchPlaceOf(node, view);
  const Vector3d v_W_m_per_s =
      RelativeVelocity(Entity(node, view, 0), Entity(node, view, 1), touch.p_W_m, view.frame);
  return Along(v_W_m_per_s, touch.nhat_W).norm();
}

// The plane in which the first touches the second, and the place in it below the first's origin:
// what turns on the spot stays there. If the plane is not known, it is the level through the
// origin.
Evaluator::TouchPlace Evaluator::TouchPlaceOf(const Node& node, const View& view) const {
  const Vector3d& origin_W_m = history_.Look(Entity(node, view, 0), view.frame).p_WB_m;
  bool swapped = false;
  const TouchSample* touch = Touch(node, view, swapped);
  if (touch == nullptr || touch->nhat_W.isZero()) return {origin_W_m, Vector3d::UnitZ()};
  const Vector3d nhat_W = swapped ? -touch->nhat_W : touch->nhat_W;
  return {origin_W_m - (origin_W_m - touch->p_W_m).dot(nhat_W) * nhat_W, nhat_W};
}

// The angle between the way in the first and the way in the second half of the window, per time
// between their middles.
std::optional<double> Evaluator::TurnRate(const Node& node, const View& view) const {
  const std::optional<Window> window = WindowAround(view.frame, node.number);
  if (!window) return std::nullopt;
  const Vector2d before = WayOn(node, view, window->early, view.frame);
  const Vector2d after = WayOn(node, view, view.frame, window->late);
  const std::optional<double> shortest_m = Number(node.args[0], view);
  if (!shortest_m) return std::nullopt;
  if (before.norm() < *shortest_m || after.norm() < *shortest_m) return 0;  // it has no direction
  const double left_rad =
      std::atan2(before.x() * after.y() - before.y() * after.x(), before.dot(after));
  return left_rad / (SecondsBetween(window->early, window->late) / 2);
}

Vector3d Evaluator::PositionOn(int a, int b, FrameNumber frame) const {
  return InFrameOf(history_.Look(b, frame), history_.Look(a, frame).p_WB_m);
}

// Of a's material against b's, at a point: turning counts, so a tray may turn under a cup.
Vector3d Evaluator::RelativeVelocity(int a, int b, const Vector3d& p_W_m, FrameNumber frame) const {
  const auto velocity = [&](int entity) -> Vector3d {
    const EntitySample& look = history_.Look(entity, frame);
    return look.v_WB_m_per_s + look.w_WB_rad_per_s.cross(p_W_m - look.p_WB_m);
  };
  return velocity(a) - velocity(b);
}

// Of the piece that touched where the interval began, along the plane in which it touched there.
std::optional<double> Evaluator::DistanceAlong(const Node& node, const View& view) const {
  const std::optional<Vector3d> piece_A = Position(node.args[0], view);
  const std::optional<Vector3d> place_B = Position(node.args[1], view);
  const std::optional<Vector3d> nhat_B = Position(node.args[2], view);
  if (!piece_A || !place_B || !nhat_B) return std::nullopt;
  const EntitySample& a = history_.Look(Entity(node, view, 0), view.frame);
  const EntitySample& b = history_.Look(Entity(node, view, 1), view.frame);
  return Along(InFrameOf(b, a.p_WB_m + a.q_WB * *piece_A) - *place_B, *nhat_B).norm();
}

Vector3d Evaluator::OfTouch(const Node& node, const View& view) const {
  const TouchPlace touch = TouchPlaceOf(node, view);
  const EntitySample& in = history_.Look(Entity(node, view, node.number > 0 ? 1 : 0), view.frame);
  if (node.op == Op::kTouchIn) return InFrameOf(in, touch.p_W_m);
  return in.q_WB.conjugate() * touch.nhat_W;
}

}  // namespace prehend::grammar
