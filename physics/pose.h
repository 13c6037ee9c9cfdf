// SPDX-License-Identifier: Apache-2.0
// A rigid pose X_AB: where frame B stands in frame A.
#pragma once

#include <Eigen/Geometry>

namespace prehend::physics {

struct Pose {
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();  ///< unit

  Pose operator*(const Pose& other) const { return {p_m + q * other.p_m, (q * other.q).normalized()}; }
  Eigen::Vector3d operator*(const Eigen::Vector3d& p) const { return p_m + q * p; }
  Pose inverse() const { return {q.conjugate() * -p_m, q.conjugate()}; }
};

}  // namespace prehend::physics
