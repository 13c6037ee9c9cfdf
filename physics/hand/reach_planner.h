// SPDX-License-Identifier: Apache-2.0
// Where a hand has to be to grasp an object in a style, and a smooth way to get there without
// touching anything. Algorithm: list the orientations that suit the object (its faces, or all
// around when it is round), keep those whose grip is at the point that was asked for, or else
// nearest to it, order them by how far the hand has to turn and to go around, and take
// the first for which one of a few Bezier curves keeps the open hand clear of every body. When none
// does, the one that stays clearest. Tested by tests/physics/hand/reach_planner_test.cc
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
      0;  ///< least distance of the open hand to any body on the way; negative: it will touch
  bool found = false;     ///< false: the best of the ways that do not do
  double beside_m = 0;    ///< how far from the point that was asked for the fingers close
  double too_wide_m = 0;  ///< how much wider the object is, where they close, than they open
};

struct ReachQuery {
  int hand = 0;    ///< index into Scene::hands
  int object = 0;  ///< index into Scene::bodies
  int style = 0;   ///< index into HandModel::styles
  Approach approach = Approach::kAuto;
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();
  /// Grasp the part of the object that is nearest to this point, there. In the object's frame.
  std::optional<Eigen::Vector3d> point_m;
  TargetState from;
  double over_s = 0.8;
};

/// Nearer than this the fingers close at the point that was asked for.
inline constexpr double kAtPoint_m = 0.01;

ReachPlan PlanReach(const Scene& scene, const Snapshot& now, const ReachQuery& query);

}  // namespace prehend::physics
