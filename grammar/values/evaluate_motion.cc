// SPDX-License-Identifier: Apache-2.0
// Signals of motion against another entity, and over a window of time.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "grammar/values/evaluate.h"

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
// later, or those at most half of it before or after; at the episode's begin and end it is cut off.
// Nothing while a frame of it is still to come.
std::optional<Evaluator::Window> Evaluator::WindowAround(const Node& node,
                                                         FrameNumber frame) const {
  Windows& windows = windows_[static_cast<std::size_t>(node.window)];
  auto& known = windows.known[static_cast<std::size_t>(frame) % windows.known.size()];
  if (known.frame == frame)  // of ticks that are forgotten the first one stands for all
    return Window{std::max(known.window.early, history_.first()), known.window.late};
  const Tick now = history_.At(frame).tick;
  const Tick early = now - windows.half;
  const Tick late = now + windows.half;
  if (history_.At(history_.now()).tick < late && !history_.complete()) return std::nullopt;
  known.frame = frame;
  known.window.early =
      windows.inside ? history_.FirstNotBefore(early) : history_.LastNotAfter(early);
  known.window.late = std::min(
      windows.inside ? history_.LastNotAfter(late) : history_.FirstNotBefore(late), history_.now());
  return known.window;
}

// Nobody who is lost in the window has a way in it.
bool Evaluator::AreSeenIn(const Window& window, const Node& node, const View& view) const {
  for (std::size_t role = 0; role < node.roles.size() && node.roles[role] != kNone; ++role) {
    const int who = Entity(node, view, role);
    if (!history_.WasLost(who)) continue;
    for (FrameNumber frame = window.early; frame <= window.late; ++frame)
      if (!IsTracked(who, frame)) return false;
  }
  return true;
}

double Evaluator::SecondsBetween(FrameNumber early, FrameNumber late) const {
  return history_.Seconds(history_.At(late).tick - history_.At(early).tick);
}

std::optional<double> Evaluator::Rate(const Node& node, const View& view) const {
  const std::optional<Window> window = WindowAround(node, view.frame);
  if (!window) return std::nullopt;
  const std::optional<double> before = Number(node.args[0], view.At(window->early));
  const std::optional<double> after = Number(node.args[0], view.At(window->late));
  if (!before || !after) return std::nullopt;
  const bool may_be_lost = std::ranges::any_of(
      view.instance.entities, [&](int entity) { return entity >= 0 && history_.WasLost(entity); });
  for (FrameNumber at = window->early + 1; may_be_lost && at < window->late; ++at)
    if (std::isnan(Number(node.args[0], view.At(at)).value_or(0))) return kNotKnown;
  if (window->early == window->late) return *after - *before;
  return (*after - *before) / SecondsBetween(window->early, window->late);
}

// In the world, or as seen from a second entity.
std::optional<double> Evaluator::SpeedOver(const Node& node, const View& view) const {
  const std::optional<Window> window = WindowAround(node, view.frame);
  if (!window) return std::nullopt;
  if (!AreSeenIn(*window, node, view)) return kNotKnown;
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
  if (op == Op::kMean)
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  if (op == Op::kMinimum) return *std::ranges::min_element(values);
  if (op == Op::kMaximum) return *std::ranges::max_element(values);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

// Of the values at the frames at most half the window before or after. Nothing while one of them
// may still come.
std::optional<double> Evaluator::OfWindow(const Node& node, const View& view) const {
  const std::optional<Window> window = WindowAround(node, view.frame);
  if (!window) return std::nullopt;
  const FrameNumber last = window->late;
  std::vector<double> values = std::exchange(window_values_, {});  // a window may be in a window
  values.clear();
  std::optional<double> value = 0;
  for (View at = view.At(window->early); at.frame <= last && value && !std::isnan(*value);
       ++at.frame) {
    value = Number(node.args[0], at);
    if (value) values.push_back(*value);
  }
  if (value && !std::isnan(*value)) value = OfValues(node.op, values);
  window_values_ = std::move(values);
  return value;
}

// Whether a value stays on one side of a number in a window; nullopt if that must be computed. What
// is lost at times is no number at some of the frames. As the window moves on, only the values that
// are new in it are looked at.
std::optional<Kleene> Evaluator::AllInWindow(const Node& node, double number,
                                             const View& view) const {
  const Node& of = program_.nodes[node.args[0]];
  const Node& value = program_.nodes[of.args[0]];
  const bool is_signal = value.op == Op::kSpeedOver || value.op == Op::kRelativeSpeedOver ||
                         value.op == Op::kDistance || value.op == Op::kHeight;
  if (!is_signal) return std::nullopt;
  int who[2] = {kNoEntity, kNoEntity};
  for (std::size_t i = 0; i < 2; ++i) {
    if (of.shared_roles[i] == kNone) continue;
    who[i] = view.instance.entities[static_cast<std::size_t>(of.shared_roles[i])];
    if (history_.WasLost(who[i])) return std::nullopt;
  }
  const std::optional<Window> window = WindowAround(of, view.frame);
  if (!window) return Kleene::kUnknown;
  if (stays_.empty()) stays_.resize(kStays);
  const std::size_t place = 7 * static_cast<std::size_t>(who[0]) +
                            61 * static_cast<std::size_t>(who[1] + 1) +
                            509 * static_cast<std::size_t>(of.shared);
  Stays& stays = stays_[place % kStays];
  const bool goes_on = stays.node == &node && stays.a == who[0] && stays.b == who[1] &&
                       stays.early <= window->early && stays.late >= window->early;
  // If the value at the last frame is known, all of them are.
  for (FrameNumber frame = window->late; frame >= (goes_on ? stays.late + 1 : window->early);
       --frame) {
    const std::optional<double> here = Number(of.args[0], view.At(frame));
    if (!here) return Kleene::kUnknown;
    if (std::isnan(*here)) return std::nullopt;
    if (!Compares(node.op, *here, number)) return Kleene::kFalse;
  }
  stays = {&node, who[0], who[1], window->early,
           goes_on ? std::max(stays.late, window->late) : window->late};
  return Kleene::kTrue;
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
  const std::optional<Window> window = WindowAround(node, view.frame);
  if (!window) return std::nullopt;
  if (!AreSeenIn(*window, node, view)) return kNotKnown;
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
  const std::optional<Window> window = WindowAround(node, view.frame);
  if (!window) return std::nullopt;
  if (!AreSeenIn(*window, node, view)) return kNotKnown;
  const Vector2d before = WayOn(node, view, window->early, view.frame);
  const Vector2d after = WayOn(node, view, view.frame, window->late);
  const std::optional<double> shortest_m = Number(node.args[0], view);
  if (!shortest_m) return std::nullopt;
  if (before.norm() < *shortest_m || after.norm() < *shortest_m) return 0;  // it has no direction
  const double left_rad =
      std::atan2(before.x() * after.y() - before.y() * after.x(), before.dot(after));
  return left_rad / (SecondsBetween(window->early, window->late) / 2);
}

namespace {

// A unit quaternion is the same as its opposite, so that the part of it that is no vector need not
// be kept.
Vector3d VectorOf(const Eigen::Quaterniond& q) { return (q.w() < 0 ? -1.0 : 1.0) * q.vec(); }
Eigen::Quaterniond FromVector(const Vector3d& vec) {
  const double squared = 1 - vec.squaredNorm();
  Eigen::Quaterniond q;
  q.w() = std::sqrt(squared < 0 ? 0 : squared);
  q.vec() = vec;
  return q;
}

// By how much it turns about an axis of what turns, between half a turn to the right and half a
// turn to the left.
double Twist(const Eigen::Quaterniond& turn, int axis) {
  const double sign = turn.w() < 0 ? -1 : 1;
  return 2 * std::atan2(sign * turn.vec()[axis], sign * turn.w());
}

}  // namespace

// Of the first role, as seen from the second or in the world.
Vector3d Evaluator::OrientationOn(const Node& node, const View& view, FrameNumber frame) const {
  const Eigen::Quaterniond& q_WA = history_.Look(Entity(node, view, 0), frame).q_WB;
  if (node.roles[1] == kNone) return VectorOf(q_WA);
  return VectorOf(history_.Look(Entity(node, view, 1), frame).q_WB.conjugate() * q_WA);
}

std::optional<double> Evaluator::Rotation(const Node& node, const View& view) const {
  const std::optional<Vector3d> now = Position(node.args[0], view);
  const std::optional<Vector3d> begun = Position(node.args[1], view);
  if (!now || !begun) return std::nullopt;
  const Eigen::Quaterniond turn = FromVector(*begun).conjugate() * FromVector(*now);
  if (node.op == Op::kTwist) return Twist(turn, node.name);
  return 2 * std::atan2(turn.vec().norm(), std::abs(turn.w()));
}

// Its turns are counted from frame to frame: those of the window alone are known up to full ones.
std::optional<double> Evaluator::Spin(const Node& node, const View& view) const {
  const std::optional<Window> window = WindowAround(node, view.frame);
  if (!window) return std::nullopt;
  if (!AreSeenIn(*window, node, view)) return kNotKnown;
  if (window->early == window->late) return 0;
  const auto turned = [&](FrameNumber early, FrameNumber late) {
    return Twist(FromVector(OrientationOn(node, view, early)).conjugate() *
                     FromVector(OrientationOn(node, view, late)),
                 node.name);
  };
  const double turn_rad = turned(window->early, window->late);
  double counted_rad = 0;
  for (FrameNumber frame = window->early; frame < window->late; ++frame)
    counted_rad += turned(frame, frame + 1);
  constexpr double kFull_rad = 2 * std::numbers::pi;
  return (turn_rad + kFull_rad * std::round((counted_rad - turn_rad) / kFull_rad)) /
         SecondsBetween(window->early, window->late);
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
