// SPDX-License-Identifier: Apache-2.0
// How far a hand in a given posture stays from the bodies of a scene, with the hand covered by
// small balls. Tested by tests/physics/hand/reach_planner_test.cc
#pragma once

#include <vector>

#include "physics/motion/trajectory.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

class HandClearance {
 public:
  HandClearance(const HandModel& model, const std::vector<double>& joints);

  /// Least distance to any body of a hand that stands at X_WH, metres; negative inside.
  double At(const Pose& X_WH, const Scene& scene, const Snapshot& now) const;
  /// The least one along a motion, looked at in even steps of time.
  double Along(const Segment& segment, const Scene& scene, const Snapshot& now) const;

 private:
  struct Ball {
    Eigen::Vector3d p_H_m;
    double radius_m;
  };
  std::vector<Ball> balls_;
  double reach_m_ = 0;  ///< radius of a ball around H's origin that holds them all
};

}  // namespace prehend::physics
