// SPDX-License-Identifier: Apache-2.0
// Distance between a hand in a given joint posture and the bodies that may obstruct it; the hand is
// covered by small spheres. Tested by tests/physics/hand/reach_planner_test.cc
#pragma once

#include <vector>

#include "physics/motion/trajectory.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

class HandClearance {
 public:
  /// `hand` is an index into Scene::hands; the scene must outlive the clearance. The person whose
  /// hand it is does not obstruct it: her arm comes along, and hands pass through persons.
  HandClearance(const Scene& scene, HandIndex hand, const std::vector<double>& joints);

  /// Smallest distance of a hand at X_WH to any body that may obstruct it, metres; negative:
  /// penetration.
  double At(const Pose& X_WH, const Snapshot& now) const;
  /// Distance of a hand at X_WH to one body, metres, at most kFar_m; exact within a few
  /// millimetres.
  double To(BodyIndex body, const Pose& X_WH, const Snapshot& now) const;
  /// Distances are cut off here; larger ones do not matter.
  static constexpr double kFar_m = 0.1;
  /// The smallest distance along a motion, sampled at even time steps.
  double Along(const Segment& segment, const Snapshot& now) const;
  /// The same, and to which body: an none if all are far.
  struct Nearest {
    double distance_m = kFar_m;
    BodyIndex body = {};
  };
  Nearest NearestAlong(const Segment& segment, const Snapshot& now) const;

 private:
  /// The distance to this body, if it is less than `least`.
  double LessTo(BodyIndex body, const Pose& X_WH, const Snapshot& now, double least) const;
  struct Ball {
    Eigen::Vector3d p_H_m;
    double radius_m;
  };
  const Scene& scene_;
  std::vector<BodyIndex> obstacles_;
  std::vector<Ball> balls_;
  double reach_m_ = 0;  ///< radius of a sphere around H's origin that encloses all
};

}  // namespace prehend::physics
