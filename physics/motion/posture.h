// SPDX-License-Identifier: Apache-2.0
// How a body holds itself, as directions: the same figure suits a tall person and a small one. What
// a recording of a whole body is turned into, and what can be mixed with another figure. Tested by
// tests/physics/motion/posture_test.cc
#pragma once

#include <array>
#include <vector>

#include "physics/motion/trajectory.h"

namespace prehend::physics {

struct Figure {
  /// Of limbs there are two each: kThigh is the right one's, kThigh + 1 the left one's.
  enum Way : std::size_t {
    kTrunk,            ///< from midway between the hip joints to midway between the shoulders
    kNeck,             ///< from there to where the head turns
    kFace,             ///< where it looks
    kCrown,            ///< from the neck to the top of the head
    kAcrossHips,       ///< to her left
    kAcrossShoulders,  ///< to her left
    kUpperArm,
    kForearm = kUpperArm + 2,
    kHand = kForearm + 2,
    kThigh = kHand + 2,
    kShank = kThigh + 2,
    kFoot = kShank + 2,  ///< from the heel to the toes
    kSole = kFoot + 2,   ///< from the ankle into the floor
    kWays = kSole + 2
  };
  Eigen::Vector3d hips_W_m = Eigen::Vector3d::Zero();  ///< midway between the hip joints
  std::array<Eigen::Vector3d, kWays> ways_W;           ///< unit
};

/// From `a`, at 0, to `b`, at 1: every way turns evenly along the shortest arc.
Figure Mix(const Figure& a, const Figure& b, double share);

struct TimedFigure {
  double t_s = 0;  ///< since the step's start, increasing
  Figure figure;
};

/// A motion through figures, passed without stopping: the hips on the monotone cubic of
/// WaypointTrajectory(), the ways turning evenly between neighbours.
class FigureTrack {
 public:
  /// Starts with `from` unless the first figure is at time 0. At least one figure.
  FigureTrack(const Figure& from, std::vector<TimedFigure> figures);
  /// Before the first: as it starts. After the last: as it ends.
  Figure At(double t_s) const;

 private:
  std::vector<TimedFigure> figures_;
  Trajectory hips_;
};

}  // namespace prehend::physics
