// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "harness/show/replay/replay_data.h"

namespace prehend::show {
namespace {

using physics::Pose;

/// The largest distance of what is interpolated from the poses, metres and radians.
std::pair<double, double> WorstOf(const std::vector<Pose>& poses,
                                  const std::vector<std::int64_t>& at) {
  const std::vector<std::size_t> keys = KeysOf(poses, at);
  std::pair<double, double> worst;
  for (std::size_t k = 0; k + 1 < keys.size(); ++k) {
    for (std::size_t i = keys[k]; i <= keys[k + 1]; ++i) {
      const double share = static_cast<double>(at[i] - at[keys[k]]) /
                           static_cast<double>(at[keys[k + 1]] - at[keys[k]]);
      const Pose pose = Between(poses[keys[k]], poses[keys[k + 1]], share);
      worst.first = std::max(worst.first, (pose.p_m - poses[i].p_m).norm());
      worst.second = std::max(worst.second, pose.q.angularDistance(poses[i].q));
    }
  }
  return worst;
}

struct Moving {
  void Add(const Pose& pose) {
    at.push_back(static_cast<std::int64_t>(at.size()));
    poses.push_back(pose);
  }
  std::vector<Pose> poses;
  std::vector<std::int64_t> at;
};

TEST(PoseTrack, WhatRestsIsOnePose) {
  Moving still;
  for (int i = 0; i < 500; ++i)
    still.Add({Eigen::Vector3d(1, 2, 3), Eigen::Quaterniond::Identity()});
  EXPECT_EQ(KeysOf(still.poses, still.at), std::vector<std::size_t>{0});
  EXPECT_TRUE(KeysOf({}, {}).empty());
}

TEST(PoseTrack, WhatIsStraightNeedsItsEnds) {
  Moving straight;
  for (int i = 0; i < 500; ++i)
    straight.Add({Eigen::Vector3d(0.01 * i, 0, 0), Eigen::Quaterniond::Identity()});
  EXPECT_EQ(KeysOf(straight.poses, straight.at), (std::vector<std::size_t>{0, 499}));
}

TEST(PoseTrack, IsNearEveryPoseAlsoAtAKick) {
  Moving kicked;
  for (int i = 0; i < 1000; ++i) {
    const double t = i / 480.0, jump = i < 500 ? 0 : 1.5 * (t - 500 / 480.0);
    kicked.Add({Eigen::Vector3d(0.3 * std::sin(4 * t), jump, 0.2 * t * t),
                Eigen::Quaterniond(Eigen::AngleAxisd(3 * t * t, Eigen::Vector3d::UnitZ()))});
  }
  const auto [off_m, off_rad] = WorstOf(kicked.poses, kicked.at);
  EXPECT_LE(off_m, kTrackTolerance_m);
  EXPECT_LE(off_rad, kTrackTolerance_rad);
  const std::vector<std::size_t> keys = KeysOf(kicked.poses, kicked.at);
  EXPECT_LT(keys.size(), 120u);
  EXPECT_EQ(keys.back(), 999u);
}

}  // namespace
}  // namespace prehend::show
