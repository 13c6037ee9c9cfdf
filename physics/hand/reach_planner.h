// SPDX-License-Identifier: Apache-2.0
// Plans a reach: where a hand must be to grasp an object in a style, and a smooth path there that
// touches nothing. Algorithm: list the orientations that suit the object (its faces, or all
// directions if it is round); keep those whose grip is at the requested point, or else nearest to
// it; order them by how far the hand has to turn and to go round; take the first for which one of a
// few Bezier curves keeps the open hand clear of every body; the person whose hand it is does not
// count. If there is none, take the curve with the largest clearance. Tested by
// tests/physics/hand/reach_planner_test.cc
#pragma once

#include "physics/motion/script.h"
#include "physics/motion/trajectory.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

struct ReachPlan {
  Segment segment;
  Eigen::Vector3d toward_W = -Eigen::Vector3d::UnitZ();  ///< direction of arrival
  double clearance_m =
      0;                ///< smallest distance of the open hand to any body; negative: it will touch
  bool found = false;   ///< false: no path is clear, and this is the best of them
  double beside_m = 0;  ///< distance of the grip from the requested point
  double width_m = 0;   ///< of the object along the grip, measured on its shape
};

struct ReachQuery {
  HandIndex hand = {};
  BodyIndex object = {};
  int style = 0;  ///< index into HandModel::styles
  Approach approach = Approach::kAuto;
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();
  /// If set, the part of the object nearest to this point (object's frame) is grasped there.
  std::optional<Eigen::Vector3d> point_m;
  TargetState from;
  double over_s = 0.8;
};

/// A grip nearer than this to the requested point counts as being at it.
inline constexpr double kAtPoint_m = 0.01;

ReachPlan PlanReach(const Scene& scene, const Snapshot& now, const ReachQuery& query);

}  // namespace prehend::physics
