// SPDX-License-Identifier: Apache-2.0
// The tracked target of a hand, which its PIDs follow, and where it goes: a chain of smooth
// segments in position, orientation and trigger, with velocities. Position follows a cubic Bezier
// curve, orientation a slerp, the trigger a straight line. A scripted motion runs with minimum-jerk
// timing (Flash & Hogan 1985) from rest to rest. Way-points are passed without stopping, on the
// monotone cubic through them (Fritsch & Butland 1984), which never overshoots a hold. Tested by
// tests/physics/motion/trajectory_test.cc
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "physics/base/pose.h"

namespace prehend::physics {

/// The tracked target at one moment. Velocities are in world axes, of the target's origin.
struct TargetState {
  Pose X_WH;
  Eigen::Vector3d v_m_per_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d w_rad_per_s = Eigen::Vector3d::Zero();
  double trigger = 0;
};

struct TimedPose {
  double t_s = 0;  ///< since the step's start, increasing
  Pose X_WH;
  std::optional<double> trigger;
};

struct Segment {
  double duration_s = 0;
  std::array<Eigen::Vector3d, 4> curve_m;  ///< Bezier control points
  Eigen::Quaterniond q_begin = Eigen::Quaterniond::Identity();
  Eigen::Quaterniond q_end = Eigen::Quaterniond::Identity();
  double turn_share = 1;  ///< share of the duration after which the orientation has settled
  double trigger_begin = 0;
  double trigger_end = 0;
  bool minimum_jerk = true;  ///< else constant rate along the curve's parameter
};

class Trajectory {
 public:
  /// At rest for ever.
  explicit Trajectory(const TargetState& rest) : rest_(rest) {}

  void Append(const Segment& segment);
  double duration_s() const { return duration_s_; }
  /// Before the begin and after the end: at rest there.
  TargetState At(double t_s) const;

 private:
  TargetState rest_;
  std::vector<Segment> segments_;
  std::vector<double> ends_s_;  ///< of the segments
  double duration_s_ = 0;
};

/// A straight motion from rest to rest, `trigger` unchanged.
Segment StraightSegment(const TargetState& from, const Pose& to, double duration_s);

/// Through way-points (times increasing); starts from `from` unless the first way-point is at time
/// 0.
Trajectory WaypointTrajectory(const TargetState& from, const std::vector<TimedPose>& poses);

/// Point on a cubic Bezier curve, parameter 0..1.
Eigen::Vector3d BezierPoint(const std::array<Eigen::Vector3d, 4>& curve_m, double s);

/// Minimum-jerk progress 0..1 at relative time x, clamped.
double MinimumJerk(double x);

}  // namespace prehend::physics
