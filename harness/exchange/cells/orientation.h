// SPDX-License-Identifier: Apache-2.0
// Numbers that say how something is turned: quaternions, angles, matrices. Tested by
// tests/harness/exchange/cells/orientation_test.cc
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <string>

namespace prehend::exchange {

inline constexpr double kUnitTolerance = 0.01;  ///< of the length of a quaternion

enum class QuaternionOrder { kWxyz, kXyzw };
enum class OrientationForm { kQuaternion, kEuler, kMatrix, kAxisAngle };

/// How numbers say an orientation.
struct OrientationFormat {
  OrientationForm form = OrientationForm::kQuaternion;
  QuaternionOrder order = QuaternionOrder::kXyzw;
  /// Of three angles: the axes that are turned about, in the order of the numbers. Capitals are the
  /// body's own axes, small letters those of the file.
  std::string euler_order = "XYZ";
  double radians_per_unit = 1;  ///< of angles
};

/// 4 numbers of a quaternion, 3 angles, 9 of a matrix row by row, 3 of an axis times its angle.
std::size_t NumbersOf(OrientationForm form);

/// Returns why they are none, or "".
std::string ReadOrientation(const OrientationFormat& format, std::span<const double> numbers,
                            Eigen::Quaterniond& q);

/// What is wrong with the order of angles, or "".
std::string FaultOfEulerOrder(const std::string& order);

}  // namespace prehend::exchange
