// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "physics/scene/hand_model.h"

namespace prehend::physics {
namespace {

/// A finger on the palm, one on that, and one that slides.
HandModel Fingers() {
  HandModel model;
  model.links.resize(3);
  model.links[0].joint_axis = {0, 1, 0};
  model.links[1].parent = LinkIndex(0);
  model.links[1].joint_axis = {0.6, 0, 0.8};
  model.links[1].pivot_m = {0.03, 0.01, 0};
  model.links[1].direction = {0, 0.6, 0.8};
  model.links[2].slides = true;
  model.links[2].joint_axis = {1, 0, 0};
  return model;
}

TEST(LinkPlaces, AreForwardKinematics) {
  const HandModel model = Fingers();
  const LinkPlaces places(model);
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> any(-1, 1);
  std::vector<Pose> found;
  for (int trial = 0; trial < 500; ++trial) {
    const Pose palm = {
        {any(random), any(random), any(random)},
        Eigen::Quaterniond(any(random), any(random), any(random), any(random)).normalized()};
    const std::vector<double> joints = {7 * any(random), 3 * any(random), any(random)};
    places.Place(palm, joints, found);
    const std::vector<Pose> exact = LinkPoses(model, joints);
    ASSERT_EQ(found.size(), exact.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_LT((found[i].p_m - palm * exact[i].p_m).norm(), 1e-12) << i;
      EXPECT_LT(found[i].q.angularDistance(palm.q * exact[i].q), 1e-7) << i;
      EXPECT_NEAR(found[i].q.norm(), 1, 1e-12) << i;
    }
  }
}

TEST(LinkPlaces, AreTheSameToTheLastBitForever) {
  std::vector<Pose> found;
  LinkPlaces(Fingers()).Place({{0.1, -0.2, 0.3}, {0.5, 0.5, -0.5, 0.5}}, {1.25, -0.75, 0.02},
                              found);
  std::vector<std::uint64_t> bits;
  for (const Pose& pose : found) {
    for (const double value :
         {pose.p_m.x(), pose.p_m.y(), pose.p_m.z(), pose.q.w(), pose.q.x(), pose.q.y(), pose.q.z()})
      bits.push_back(std::bit_cast<std::uint64_t>(value));
  }
  std::uint64_t hash = 0;
  for (const std::uint64_t word : bits) hash = (hash ^ word) * 1099511628211ULL;
  EXPECT_EQ(hash, 13264735025625644197u) << "episode files would not say what was recorded";
}

}  // namespace
}  // namespace prehend::physics
