// SPDX-License-Identifier: Apache-2.0
#include "physics/hand/pid.h"

#include <gtest/gtest.h>

namespace prehend::physics {
namespace {

const PidGains kGains{
    .proportional = 100, .derivative = 10, .integral = 50, .limit = 20, .integral_share = 0.5};

TEST(VectorPidTest, SumsItsPartsBelowTheLimit) {
  VectorPid pid(kGains);
  EXPECT_NEAR(pid.Output({0.1, 0, 0}, {0, 0.2, 0}, 0.1).x(), 10, 1e-12);
  // The error of the first tick has been integrated: 0.1 * 0.1 * 50.
  EXPECT_NEAR(pid.Output({0, 0, 0}, {0, 0.2, 0}, 0.1).x(), 0.5, 1e-12);
}

TEST(VectorPidTest, IsLimitedInLengthAndKeepsItsDirection) {
  VectorPid pid(kGains);
  const Eigen::Vector3d output = pid.Output({3, 4, 0}, {0, 0, 0}, 0.1);
  EXPECT_NEAR(output.norm(), 20, 1e-12);
  EXPECT_NEAR(output.y() / output.x(), 4.0 / 3, 1e-12);
}

TEST(VectorPidTest, TheIntegralIsFrozenWhileSaturatedAndBoundedAfterwards) {
  VectorPid saturated(kGains);
  for (int i = 0; i < 100; ++i) saturated.Output({1, 0, 0}, {0, 0, 0}, 0.1);
  EXPECT_NEAR(saturated.Output({0, 0, 0}, {0, 0, 0}, 0.1).norm(), 0, 1e-12);

  VectorPid patient(kGains);
  for (int i = 0; i < 1000; ++i) patient.Output({0.05, 0, 0}, {0, 0, 0}, 0.1);
  EXPECT_NEAR(patient.Output({0, 0, 0}, {0, 0, 0}, 0.1).x(), 10, 1e-9);
}

TEST(VectorPidTest, WhatBalancesAnErrorFades) {
  const Eigen::Vector3d error(0.1, 0, 0), still(0, 0, 0);
  VectorPid pid({.proportional = 100, .derivative = 10, .integral = 50, .limit = 20});
  double output_n = pid.Output(error, still, 0.002).x();
  EXPECT_GT(output_n, 9);
  for (int i = 0; i < 100; ++i) output_n = pid.Output(error, still, 0.002, true).x();
  EXPECT_LT(output_n, 0.6) << "0.2 s later";
  EXPECT_GT(pid.Output({0.11, 0, 0}, still, 0.002).x(), 1) << "it still holds its place";
}

}  // namespace
}  // namespace prehend::physics
