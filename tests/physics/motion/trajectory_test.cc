// SPDX-License-Identifier: Apache-2.0
#include "physics/motion/trajectory.h"

#include <gtest/gtest.h>

namespace prehend::physics {
namespace {

using Eigen::Quaterniond, Eigen::Vector3d;

/// The stated velocities are the derivatives of the stated poses.
void ExpectConsistentRates(const Trajectory& trajectory) {
  constexpr double kStep_s = 1e-5;
  for (double t = 0.013; t < trajectory.duration_s() - 0.01; t += 0.05) {
    const TargetState before = trajectory.At(t - kStep_s), now = trajectory.At(t),
                      after = trajectory.At(t + kStep_s);
    const Vector3d v = (after.X_WH.p_m - before.X_WH.p_m) / (2 * kStep_s);
    const Vector3d w = RotationVector(after.X_WH.q * before.X_WH.q.conjugate()) / (2 * kStep_s);
    EXPECT_LT((v - now.v_m_per_s).norm(), 1e-4) << t;
    EXPECT_LT((w - now.w_rad_per_s).norm(), 1e-4) << t;
  }
}

TEST(TrajectoryTest, AStraightMotionGoesFromRestToRest) {
  const TargetState from{.X_WH = {{1, 2, 3}}, .trigger = 0.4};
  Trajectory trajectory(from);
  trajectory.Append(
      StraightSegment(from, {{2, 2, 3}, Quaterniond(Eigen::AngleAxisd(1, Vector3d::UnitZ()))}, 2));
  EXPECT_LT((trajectory.At(0).X_WH.p_m - Vector3d(1, 2, 3)).norm(), 1e-12);
  EXPECT_LT((trajectory.At(1).X_WH.p_m - Vector3d(1.5, 2, 3)).norm(), 1e-12);
  EXPECT_LT((trajectory.At(5).X_WH.p_m - Vector3d(2, 2, 3)).norm(), 1e-12);
  EXPECT_EQ(trajectory.At(5).v_m_per_s, Vector3d::Zero());
  EXPECT_NEAR(trajectory.At(1).v_m_per_s.x(), 1.875 / 2, 1e-9);  // peak of a minimum-jerk motion
  EXPECT_EQ(trajectory.At(1).trigger, 0.4);
  ExpectConsistentRates(trajectory);
}

TEST(TrajectoryTest, WaypointsArePassedAndNeverOvershot) {
  const std::vector<TimedPose> poses = {{.t_s = 0.5, .X_WH = {{1, 0, 0}}},
                                        {.t_s = 1.0, .X_WH = {{1, 0, 0}}, .trigger = 1.0},
                                        {.t_s = 2.0, .X_WH = {{3, 1, 0}, Quaterniond(0, 0, 0, 1)}}};
  const Trajectory trajectory = WaypointTrajectory({}, poses);
  for (const TimedPose& pose : poses)
    EXPECT_LT((trajectory.At(pose.t_s).X_WH.p_m - pose.X_WH.p_m).norm(), 1e-9);
  for (double t = 0; t <= 2; t += 0.01) {
    EXPECT_LE(trajectory.At(t).X_WH.p_m.x(), t <= 1 ? 1 + 1e-9 : 3 + 1e-9);
    EXPECT_GE(trajectory.At(t).X_WH.p_m.y(), -1e-9);
  }
  EXPECT_NEAR(trajectory.At(0.75).X_WH.p_m.x(), 1, 1e-9);
  EXPECT_NEAR(trajectory.At(0.75).trigger, 0.5, 1e-9);
  ExpectConsistentRates(trajectory);
}

TEST(TrajectoryTest, AWayThroughWaypointsTurnsWithThem) {
  const Quaterniond turn(Eigen::AngleAxisd(0.65, Vector3d::UnitZ()));
  std::vector<TimedPose> poses, turned;
  for (int i = 1; i <= 12; ++i) {  // a circle of 5 cm
    const double angle = i * 0.52;
    poses.push_back({.t_s = 0.1 * i, .X_WH = {{0.05 - 0.05 * cos(angle), 0.05 * sin(angle), 0}}});
    turned.push_back({.t_s = 0.1 * i, .X_WH = {turn * poses.back().X_WH.p_m}});
  }
  const Trajectory way = WaypointTrajectory({}, poses), its = WaypointTrajectory({}, turned);
  for (double t = 0; t <= 1.2; t += 0.01)
    EXPECT_LT((turn * way.At(t).X_WH.p_m - its.At(t).X_WH.p_m).norm(), 1e-12) << t;
  // Between way-points it stays near the circle.
  for (double t = 0.1; t <= 1.1; t += 0.01)
    EXPECT_NEAR((way.At(t).X_WH.p_m - Vector3d(0.05, 0, 0)).norm(), 0.05, 0.0003) << t;
}

TEST(TrajectoryTest, AWayThatIsDownGoesNoDeeper) {
  const Trajectory way =
      WaypointTrajectory({.X_WH = {{0, 0, 1}}}, {{.t_s = 1, .X_WH = {{1, 0, 0}}},
                                                 {.t_s = 2, .X_WH = {{2, 1, 0}}},
                                                 {.t_s = 3, .X_WH = {{3, 1, 1}}}});
  for (double t = 0; t <= 3; t += 0.01) EXPECT_GE(way.At(t).X_WH.p_m.z(), -1e-12) << t;
  EXPECT_GT(way.At(1).v_m_per_s.x(), 0.5);
}

TEST(TrajectoryTest, AFirstWaypointAtZeroIsTheStart) {
  const Trajectory trajectory =
      WaypointTrajectory({}, {{.t_s = 0, .X_WH = {{5, 0, 0}}}, {.t_s = 1, .X_WH = {{6, 0, 0}}}});
  EXPECT_NEAR(trajectory.At(0).X_WH.p_m.x(), 5, 1e-12);
}

}  // namespace
}  // namespace prehend::physics
