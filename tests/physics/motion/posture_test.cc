// SPDX-License-Identifier: Apache-2.0
// Postures: mixing, and going through them in time.

#include "physics/motion/posture.h"

#include <gtest/gtest.h>

#include <cmath>

namespace prehend::physics {
namespace {

using Eigen::Vector3d;

Posture AllDirections(const Vector3d& way, const Vector3d& hips_m) {
  Posture posture{.hips_W_m = hips_m, .directions_W = {}};
  posture.directions_W.fill(way);
  return posture;
}

TEST(PostureTest, HalfWayBetweenTwoWaysIsTheirBisector) {
  const Posture mixed = Mix(AllDirections(Vector3d::UnitX(), {0, 0, 1}),
                            AllDirections(Vector3d::UnitZ(), {1, 0, 1}), 0.5);
  EXPECT_LT(
      (mixed.directions_W[Posture::kTrunk] - Vector3d(std::sqrt(0.5), 0, std::sqrt(0.5))).norm(),
      1e-12);
  EXPECT_LT((mixed.directions_W[Posture::kSole + 1] - mixed.directions_W[Posture::kTrunk]).norm(),
            1e-12);
  EXPECT_LT((mixed.hips_W_m - Vector3d(0.5, 0, 1)).norm(), 1e-12);
}

TEST(PostureTest, WaysStayUnitEvenWhenTheyTurnRound) {
  const Posture mixed = Mix(AllDirections(Vector3d::UnitX(), Vector3d::Zero()),
                            AllDirections(-Vector3d::UnitX(), Vector3d::Zero()), 0.3);
  for (const Vector3d& way : mixed.directions_W) EXPECT_NEAR(way.norm(), 1, 1e-9);
}

TEST(PostureTrackTest, PassesEveryPostureAtItsTime) {
  const Posture from = AllDirections(Vector3d::UnitX(), {0, 0, 0.9});
  const PostureTrack track(from, {{0.5, AllDirections(Vector3d::UnitY(), {0.2, 0, 0.9})},
                                  {1.5, AllDirections(Vector3d::UnitZ(), {0.3, 0, 0.8})}});
  EXPECT_EQ(track.At(-1).hips_W_m, from.hips_W_m);
  EXPECT_LT((track.At(0.5).hips_W_m - Vector3d(0.2, 0, 0.9)).norm(), 1e-12);
  EXPECT_LT((track.At(0.5).directions_W[0] - Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_NEAR(track.At(0.25).directions_W[0].x(), std::sqrt(0.5), 1e-12);
  EXPECT_LT((track.At(9).directions_W[0] - Vector3d::UnitZ()).norm(), 1e-12);
}

TEST(PostureTrackTest, AFirstPostureAtZeroIsJumpedTo) {
  const PostureTrack track(AllDirections(Vector3d::UnitX(), Vector3d::Zero()),
                           {{0, AllDirections(Vector3d::UnitY(), Vector3d::Zero())}});
  EXPECT_LT((track.At(0).directions_W[0] - Vector3d::UnitY()).norm(), 1e-12);
}

}  // namespace
}  // namespace prehend::physics
