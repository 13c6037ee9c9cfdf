// SPDX-License-Identifier: Apache-2.0
// Tested by tests/physics/figure_test.cc
#include "physics/figure.h"

namespace prehend::physics {
namespace {

Eigen::Vector3d TurnedToward(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double share) {
  const Eigen::Quaterniond whole = Eigen::Quaterniond::FromTwoVectors(a, b);
  return Eigen::Quaterniond::Identity().slerp(share, whole) * a;
}

}  // namespace

Figure Mix(const Figure& a, const Figure& b, double share) {
  Figure mixed{.hips_W_m = a.hips_W_m + share * (b.hips_W_m - a.hips_W_m), .ways_W = {}};
  for (std::size_t i = 0; i < Figure::kWays; ++i)
    mixed.ways_W[i] = TurnedToward(a.ways_W[i], b.ways_W[i], share);
  return mixed;
}

}  // namespace prehend::physics
