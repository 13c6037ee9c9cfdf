// SPDX-License-Identifier: Apache-2.0
// The tracked target of a hand, which its PIDs follow.
#pragma once

#include "physics/pose.h"

namespace prehend::physics {

/// The tracked target at one moment. Velocities are in world axes, of the target's origin.
struct TargetState {
  Pose X_WH;
  Eigen::Vector3d v_m_per_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d w_rad_per_s = Eigen::Vector3d::Zero();
  double trigger = 0;
};

}  // namespace prehend::physics
