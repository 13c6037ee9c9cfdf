// SPDX-License-Identifier: Apache-2.0
// Rotations that are costly to compile.
#include "physics/base/pose.h"

#include <algorithm>
#include <cmath>

namespace prehend::physics {

Eigen::Quaterniond RotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

Eigen::Vector3d ToRollPitchYaw(const Eigen::Quaterniond& q) {
  const Eigen::Matrix3d R = q.normalized().toRotationMatrix();
  const double pitch = std::asin(std::clamp(-R(2, 0), -1.0, 1.0));
  // Looking straight up or down, roll and yaw turn about the same axis: all of it is yaw.
  const bool is_upright = std::abs(R(2, 0)) > 1 - 1e-12;
  const double roll = is_upright ? 0 : std::atan2(R(2, 1), R(2, 2));
  const double yaw = is_upright ? std::atan2(-R(0, 1), R(1, 1)) : std::atan2(R(1, 0), R(0, 0));
  return Eigen::Vector3d(roll, pitch, yaw) * (180 / std::numbers::pi);
}

}  // namespace prehend::physics
