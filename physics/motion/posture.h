// SPDX-License-Identifier: Apache-2.0
// How a body holds itself, as directions of its bones, so that the same figure suits a tall and a
// small person. A recording of a whole body becomes figures, and figures can be interpolated.
// Tested by tests/physics/motion/posture_test.cc
#pragma once

#include <array>
#include <vector>

#include "physics/motion/trajectory.h"

namespace prehend::physics {

struct Figure {
  /// Limbs have two entries each: kThigh is the right one, kThigh + 1 the left one.
  enum Way : std::size_t {
    kTrunk,            ///< from midway between the hip joints to midway between the shoulders
    kNeck,             ///< from there to the joint of the head
    kFace,             ///< direction of the face
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

/// Interpolates from `a` (share 0) to `b` (share 1): every direction turns evenly along the
/// shortest arc.
Figure Mix(const Figure& a, const Figure& b, double share);

struct TimedFigure {
  double t_s = 0;  ///< since the step's start, increasing
  Figure figure;
};

/// A motion through figures without stops: the hips move on the monotone cubic of
/// WaypointTrajectory(), directions turn evenly between neighbours.
class FigureTrack {
 public:
  /// Starts from `from` unless the first figure is at time 0. Requires at least one figure.
  FigureTrack(const Figure& from, std::vector<TimedFigure> figures);
  /// The figure at a time; the first one before its begin, the last one after its end.
  Figure At(double t_s) const;

 private:
  std::vector<TimedFigure> figures_;
  Trajectory hips_;
};

}  // namespace prehend::physics
