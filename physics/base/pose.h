// SPDX-License-Identifier: Apache-2.0
// Rigid poses and rotations. X_AB is the pose of frame B in frame A. Tested by
// tests/physics/base/pose_test.cc
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace prehend::physics {

inline constexpr double kRadPerDeg = std::numbers::pi / 180;

struct Pose {
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();  ///< unit

  Pose operator*(const Pose& other) const {
    return {p_m + q * other.p_m, (q * other.q).normalized()};
  }
  Eigen::Vector3d operator*(const Eigen::Vector3d& p) const { return p_m + q * p; }
  Pose inverse() const { return {q.conjugate() * -p_m, q.conjugate()}; }
};

/// The rotation vector: unit axis times angle in [0, pi].
inline Eigen::Vector3d RotationVector(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0 ? -1 : 1;
  const double sine = q.vec().norm();
  if (sine < 1e-9) return 2 * sign * q.vec();
  return q.vec() * (2 * sign * std::atan2(sine, sign * q.w()) / sine);
}

/// The shortest rotation from one direction to another; neither has to be a unit vector. Eigen's
/// FromTwoVectors, which compiles a singular value decomposition wherever it is called: therefore
/// only in physics/base/pose.cc.
Eigen::Quaterniond RotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// The inverse of FromRollPitchYaw(): pitch from -90 to 90.
Eigen::Vector3d ToRollPitchYaw(const Eigen::Quaterniond& q);

/// Rotates about the world's x, then y, then z axis; degrees.
inline Eigen::Quaterniond FromRollPitchYaw(const Eigen::Vector3d& rpy_deg) {
  const Eigen::Vector3d rad = rpy_deg * std::numbers::pi / 180;
  return Eigen::AngleAxisd(rad.z(), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(rad.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(rad.x(), Eigen::Vector3d::UnitX());
}

}  // namespace prehend::physics
