// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>

#include "harness/exchange/cells/table_cells.h"

namespace prehend::exchange {
namespace {

Eigen::Quaterniond Turned(double degrees, int axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * static_cast<double>(EIGEN_PI) / 180,
                                              Eigen::Vector3d::Unit(axis)));
}

double Off(const OrientationFormat& format, std::vector<double> numbers,
           const Eigen::Quaterniond& wanted) {
  Eigen::Quaterniond q;
  EXPECT_EQ(ReadOrientation(format, numbers, q), "");
  return q.angularDistance(wanted);
}

TEST(Orientation, AnglesTurnAboutTheBodysAxesOrTheFiles) {
  const OrientationFormat own{.form = OrientationForm::kEuler,
                              .euler_order = "XYZ",
                              .radians_per_unit = static_cast<double>(EIGEN_PI) / 180};
  OrientationFormat files = own;
  files.euler_order = "zyx";
  const Eigen::Quaterniond wanted = Turned(20, 0) * Turned(-50, 1) * Turned(130, 2);
  EXPECT_NEAR(Off(own, {20, -50, 130}, wanted), 0, 1e-7);
  EXPECT_NEAR(Off(files, {130, -50, 20}, wanted), 0, 1e-7);
}

TEST(Orientation, MatricesAxesAndQuaternions) {
  const Eigen::Quaterniond wanted = Turned(20, 0) * Turned(-50, 1) * Turned(130, 2);
  const Eigen::Matrix3d m = wanted.toRotationMatrix();
  EXPECT_NEAR(Off({.form = OrientationForm::kMatrix},
                  {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)},
                  wanted),
              0, 1e-7);
  const Eigen::AngleAxisd turn(wanted);
  const Eigen::Vector3d v = turn.axis() * turn.angle();
  EXPECT_NEAR(Off({.form = OrientationForm::kAxisAngle}, {v[0], v[1], v[2]}, wanted), 0, 1e-7);
  EXPECT_NEAR(Off({.form = OrientationForm::kAxisAngle}, {0, 0, 0}, Turned(0, 0)), 0, 1e-7);
  EXPECT_NEAR(Off({.order = QuaternionOrder::kWxyz},
                  {wanted.w(), wanted.x(), wanted.y(), wanted.z()}, wanted),
              0, 1e-7);
}

TEST(Orientation, NumbersThatAreNoneAreSaid) {
  Eigen::Quaterniond q;
  const std::array<double, 9> mirror = {-1, 0, 0, 0, 1, 0, 0, 0, 1}, zero = {};
  const OrientationFormat matrix{.form = OrientationForm::kMatrix};
  EXPECT_EQ(ReadOrientation(matrix, mirror, q),
            "expected a rotation matrix, found one that mirrors");
  EXPECT_NE(ReadOrientation(matrix, zero, q), "");
  EXPECT_NE(ReadOrientation({}, std::span(zero).first(4), q), "");
  EXPECT_EQ(FaultOfEulerOrder("XYX"), "");
  for (const char* order : {"XXY", "xyZ", "xy", "abc", "xyzx"})
    EXPECT_NE(FaultOfEulerOrder(order), "") << order;
}

}  // namespace
}  // namespace prehend::exchange
