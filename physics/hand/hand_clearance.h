// SPDX-License-Identifier: Apache-2.0
// Distance between a hand in a given joint posture and the bodies of a scene; the hand is covered
// by small spheres. Tested by tests/physics/hand/reach_planner_test.cc
#pragma once

#include <vector>

#include "physics/motion/trajectory.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

class HandClearance {
 public:
  HandClearance(const HandModel& model, const std::vector<double>& joints);

  /// Smallest distance of a hand at X_WH to any body, metres; negative: penetration.
  double At(const Pose& X_WH, const Scene& scene, const Snapshot& now) const;
  /// The smallest distance along a motion, sampled at even time steps.
  double Along(const Segment& segment, const Scene& scene, const Snapshot& now) const;

 private:
  struct Ball {
    Eigen::Vector3d p_H_m;
    double radius_m;
  };
  std::vector<Ball> balls_;
  double reach_m_ = 0;  ///< radius of a sphere around H's origin that encloses all
};

}  // namespace prehend::physics
