// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/cells/orientation.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <cmath>

namespace prehend::exchange {
namespace {

constexpr double kMatrixTolerance = 0.02;  ///< of the lengths of rows and of their products

int AxisOf(char letter) { return std::tolower(static_cast<unsigned char>(letter)) - 'x'; }

std::string ReadMatrix(std::span<const double> v, Eigen::Quaterniond& q) {
  Eigen::Matrix3d m;
  m << v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8];
  const double off = (m * m.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(off <= kMatrixTolerance))
    return fmt::format(
        "expected a rotation matrix, found one whose rows are {:.3g} off unit "
        "length or right angles",
        off);
  if (m.determinant() < 0) return "expected a rotation matrix, found one that mirrors";
  q = Eigen::Quaterniond(m).normalized();
  return "";
}

}  // namespace

std::size_t NumbersOf(OrientationForm form) {
  constexpr std::array<std::size_t, 4> kNumbers = {4, 3, 9, 3};
  return kNumbers[static_cast<std::size_t>(form)];
}

std::string ReadOrientation(const OrientationFormat& format, std::span<const double> v,
                            Eigen::Quaterniond& q) {
  switch (format.form) {
    case OrientationForm::kQuaternion:
      q = format.order == QuaternionOrder::kWxyz ? Eigen::Quaterniond(v[0], v[1], v[2], v[3])
                                                 : Eigen::Quaterniond(v[3], v[0], v[1], v[2]);
      if (!(std::abs(q.norm() - 1) <= kUnitTolerance))
        return fmt::format("expected a unit quaternion, found one of length {:.4g}", q.norm());
      break;
    case OrientationForm::kEuler:
      q.setIdentity();
      for (std::size_t i = 0; i < 3; ++i) {
        const char letter = format.euler_order[i];
        const Eigen::Quaterniond turn(Eigen::AngleAxisd(v[i] * format.radians_per_unit,
                                                        Eigen::Vector3d::Unit(AxisOf(letter))));
        q = letter <= 'Z' ? q * turn : turn * q;
      }
      break;
    case OrientationForm::kMatrix:
      return ReadMatrix(v, q);
    case OrientationForm::kAxisAngle: {
      const Eigen::Vector3d turn = Eigen::Vector3d(v[0], v[1], v[2]) * format.radians_per_unit;
      const double angle = turn.norm();
      q.setIdentity();
      if (angle > 0) q = Eigen::AngleAxisd(angle, turn / angle);
      break;
    }
  }
  q.normalize();
  return "";
}

std::string FaultOfEulerOrder(const std::string& order) {
  const bool three = order.size() == 3 && (order.find_first_not_of("XYZ") == std::string::npos ||
                                           order.find_first_not_of("xyz") == std::string::npos);
  if (three && order[0] != order[1] && order[1] != order[2]) return "";
  return fmt::format(
      "expected three axes like XYZ (the body's own) or xyz (the file's), no two "
      "neighbours alike, found '{}'",
      order);
}

}  // namespace prehend::exchange
