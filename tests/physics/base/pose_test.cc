// SPDX-License-Identifier: Apache-2.0
#include "physics/base/pose.h"

#include <gtest/gtest.h>

namespace prehend::physics {
namespace {

using Eigen::Vector3d;

TEST(PoseTest, RotationBetweenTurnsOneDirectionIntoTheOther) {
  const Vector3d to(0.1, -3, 0.4);
  const Eigen::Quaterniond turn = RotationBetween({2, 0, 0}, to);
  EXPECT_LT((turn * Vector3d::UnitX() - to.normalized()).norm(), 1e-12);
  EXPECT_LT(std::abs(turn.vec().dot(to)), 1e-12) << "the shortest one turns about a normal of both";
}

TEST(PoseTest, RotationBetweenOppositeDirectionsIsAHalfTurn) {
  for (const Vector3d& from : {Vector3d(1, 0, 0), Vector3d(0, 0, -2), Vector3d(1, 2, 3)}) {
    const Eigen::Quaterniond turn = RotationBetween(from, -from);
    EXPECT_LT((turn * from + from).norm(), 1e-9) << from.transpose();
    EXPECT_NEAR(turn.norm(), 1, 1e-12);
  }
}

TEST(PoseTest, RollPitchAndYawAreAboutTheWorldsAxesInThisOrder) {
  EXPECT_LT((FromRollPitchYaw({90, 0, 90}) * Vector3d::UnitY() - Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_LT((FromRollPitchYaw({90, 0, 90}) * Vector3d::UnitZ() - Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_LT((FromRollPitchYaw({0, 90, 0}) * Vector3d::UnitX() + Vector3d::UnitZ()).norm(), 1e-12);
}

TEST(PoseTest, RollPitchYawComesBack) {
  for (const Eigen::Vector3d& rpy_deg :
       {Eigen::Vector3d(10, 20, 30), Eigen::Vector3d(-170, 80, 179), Eigen::Vector3d(0, 90, 40),
        Eigen::Vector3d(0, -90, -100), Eigen::Vector3d(0, 0, 0)}) {
    const Eigen::Quaterniond q = FromRollPitchYaw(rpy_deg);
    EXPECT_LT(FromRollPitchYaw(ToRollPitchYaw(q)).angularDistance(q), 1e-6) << rpy_deg.transpose();
  }
}

}  // namespace
}  // namespace prehend::physics
