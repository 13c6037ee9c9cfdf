// SPDX-License-Identifier: Apache-2.0
// Rotations that are costly to compile. Tested by tests/physics/scene/pose_test.cc
#include "physics/scene/pose.h"

namespace prehend::physics {

Eigen::Quaterniond RotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

}  // namespace prehend::physics
