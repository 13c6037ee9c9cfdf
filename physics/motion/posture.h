// SPDX-License-Identifier: Apache-2.0
// How a body holds itself, as directions of its bones, so that the same posture suits a tall and a
// small person. A recording of a whole body becomes postures, and postures can be interpolated.
// Tested by tests/physics/motion/posture_test.cc
#pragma once

#include <array>
#include <vector>

#include "physics/motion/trajectory.h"

namespace prehend::physics {

struct Posture {
  /// Limbs have two entries each: kThigh is the right one, kThigh + 1 the left one.
  enum Direction : std::size_t {
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
    kDirections = kSole + 2
  };
  Eigen::Vector3d hips_W_m = Eigen::Vector3d::Zero();     ///< midway between the hip joints
  std::array<Eigen::Vector3d, kDirections> directions_W;  ///< unit
};

/// Interpolates from `a` (share 0) to `b` (share 1): every direction turns evenly along the
/// shortest arc.
Posture Mix(const Posture& a, const Posture& b, double share);

struct TimedPosture {
  double t_s = 0;  ///< since the step's start, increasing
  Posture posture;
};

/// A motion through postures without stops: the hips move on the monotone cubic of
/// WaypointTrajectory(), directions turn evenly between neighbours.
class PostureTrack {
 public:
  /// Starts from `from` unless the first posture is at time 0. Requires at least one posture.
  PostureTrack(const Posture& from, std::vector<TimedPosture> postures);
  /// The posture at a time; the first one before its begin, the last one after its end.
  Posture At(double t_s) const;

 private:
  std::vector<TimedPosture> postures_;
  Trajectory hips_;
};

}  // namespace prehend::physics
