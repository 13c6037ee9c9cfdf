// SPDX-License-Identifier: Apache-2.0
// Segments are looked up by their end times.
#include "physics/motion/trajectory.h"

#include <algorithm>

namespace prehend::physics {
namespace {

double MinimumJerkRate(double x) {
  if (x <= 0 || x >= 1) return 0;
  return 30 * x * x * (1 - 2 * x + x * x);
}

Eigen::Vector3d BezierTangent(const std::array<Eigen::Vector3d, 4>& c, double s) {
  const double r = 1 - s;
  return 3 * r * r * (c[1] - c[0]) + 6 * r * s * (c[2] - c[1]) + 3 * s * s * (c[3] - c[2]);
}

TargetState SegmentAt(const Segment& segment, double t_s) {
  const double x = t_s / segment.duration_s;
  const double turn_x = std::min(x / segment.turn_share, 1.0);
  const bool smooth = segment.minimum_jerk;
  const double s = smooth ? MinimumJerk(x) : x;
  const double s_rate = (smooth ? MinimumJerkRate(x) : 1.0) / segment.duration_s;
  const double turn = smooth ? MinimumJerk(turn_x) : turn_x;
  const double turn_duration_s = segment.duration_s * segment.turn_share;
  const double turn_rate = (smooth ? MinimumJerkRate(turn_x) : 1.0) / turn_duration_s;

  TargetState state;
  state.X_WH.p_m = BezierPoint(segment.curve_m, s);
  state.X_WH.q = segment.q_begin.slerp(turn, segment.q_end).normalized();
  state.v_m_per_s = BezierTangent(segment.curve_m, s) * s_rate;
  state.w_rad_per_s = RotationVector(segment.q_end * segment.q_begin.conjugate()) * turn_rate;
  state.trigger = segment.trigger_begin + x * (segment.trigger_end - segment.trigger_begin);
  return state;
}

/// Slope at a way-point between two slopes: their harmonic mean, or zero if they turn by a right
/// angle or more. Of heights by themselves: a way that was down does not go deeper.
Eigen::Vector3d MonotoneRate(const Eigen::Vector3d& before, const Eigen::Vector3d& after) {
  const auto mean = [](const auto& a, const auto& b) {
    const double product = a.dot(b);
    return ((a + b) * (product > 0 ? 2 * product / (a + b).squaredNorm() : 0)).eval();
  };
  Eigen::Vector3d rate;
  rate << mean(before.head<2>(), after.head<2>()), mean(before.tail<1>(), after.tail<1>());
  return rate;
}

}  // namespace

double MinimumJerk(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * x * (10 - 15 * x + 6 * x * x);
}

Eigen::Vector3d BezierPoint(const std::array<Eigen::Vector3d, 4>& c, double s) {
  const double r = 1 - s;
  return r * r * r * c[0] + 3 * r * r * s * c[1] + 3 * r * s * s * c[2] + s * s * s * c[3];
}

void Trajectory::Append(const Segment& segment) {
  if (segment.duration_s > 0) {
    segments_.push_back(segment);
    duration_s_ += segment.duration_s;
    ends_s_.push_back(duration_s_);
  }
  rest_ = {.X_WH = {segment.curve_m[3], segment.q_end}, .trigger = segment.trigger_end};
}

TargetState Trajectory::At(double t_s) const {
  const auto end = std::upper_bound(ends_s_.begin(), ends_s_.end(), t_s);
  if (end == ends_s_.end()) return rest_;
  const double begin_s = end == ends_s_.begin() ? 0 : *std::prev(end);
  const Segment& segment = segments_[static_cast<std::size_t>(end - ends_s_.begin())];
  return SegmentAt(segment, std::max(t_s - begin_s, 0.0));
}

Segment StraightSegment(const TargetState& from, const Pose& to, double duration_s) {
  const Eigen::Vector3d third = (to.p_m - from.X_WH.p_m) / 3;
  return {.duration_s = duration_s,
          .curve_m = {from.X_WH.p_m, from.X_WH.p_m + third, to.p_m - third, to.p_m},
          .q_begin = from.X_WH.q,
          .q_end = to.q,
          .trigger_begin = from.trigger,
          .trigger_end = from.trigger};
}

Trajectory WaypointTrajectory(const TargetState& from, const std::vector<TimedPose>& poses) {
  std::vector<TimedPose> points = poses;
  if (points.front().t_s > 0) points.insert(points.begin(), {.t_s = 0, .X_WH = from.X_WH});
  double trigger = from.trigger;
  for (TimedPose& point : points) {
    if (!point.trigger) point.trigger = trigger;
    trigger = *point.trigger;
  }

  const auto slope = [&](std::size_t i) -> Eigen::Vector3d {
    return (points[i + 1].X_WH.p_m - points[i].X_WH.p_m) / (points[i + 1].t_s - points[i].t_s);
  };
  const auto rate = [&](std::size_t i) -> Eigen::Vector3d {
    if (i == 0 || i + 1 == points.size()) return Eigen::Vector3d::Zero();
    return MonotoneRate(slope(i - 1), slope(i));
  };
  Trajectory trajectory({.X_WH = points.front().X_WH, .trigger = *points.front().trigger});
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const TimedPose &a = points[i], &b = points[i + 1];
    const double duration_s = b.t_s - a.t_s;
    trajectory.Append({.duration_s = duration_s,
                       .curve_m = {a.X_WH.p_m, a.X_WH.p_m + rate(i) * duration_s / 3,
                                   b.X_WH.p_m - rate(i + 1) * duration_s / 3, b.X_WH.p_m},
                       .q_begin = a.X_WH.q,
                       .q_end = b.X_WH.q,
                       .trigger_begin = *a.trigger,
                       .trigger_end = *b.trigger,
                       .minimum_jerk = false});
  }
  return trajectory;
}

}  // namespace prehend::physics
