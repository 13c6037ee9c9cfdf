// SPDX-License-Identifier: Apache-2.0
// Directions turn along great circles.
#include "physics/motion/posture.h"

#include <algorithm>

namespace prehend::physics {
namespace {

Eigen::Vector3d TurnedToward(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double share) {
  const Eigen::Quaterniond whole = RotationBetween(a, b);
  return Eigen::Quaterniond::Identity().slerp(share, whole) * a;
}

Trajectory HipsOf(const std::vector<TimedPosture>& postures) {
  std::vector<TimedPose> poses;
  for (const TimedPosture& timed : postures)
    poses.push_back({.t_s = timed.t_s, .X_WH = {timed.posture.hips_W_m}});
  return WaypointTrajectory({}, poses);
}

std::vector<TimedPosture> StartingWith(const Posture& from, std::vector<TimedPosture> postures) {
  if (postures.front().t_s > 0) postures.insert(postures.begin(), {0, from});
  return postures;
}

}  // namespace

Posture Mix(const Posture& a, const Posture& b, double share) {
  Posture mixed{.hips_W_m = a.hips_W_m + share * (b.hips_W_m - a.hips_W_m)};
  for (std::size_t i = 0; i < Posture::kDirections; ++i)
    mixed.directions_W[i] = TurnedToward(a.directions_W[i], b.directions_W[i], share);
  return mixed;
}

PostureTrack::PostureTrack(const Posture& from, std::vector<TimedPosture> postures)
    : postures_(StartingWith(from, std::move(postures))), hips_(HipsOf(postures_)) {}

Posture PostureTrack::At(double t_s) const {
  const auto next = std::upper_bound(postures_.begin(), postures_.end(), t_s,
                                     [](double t, const TimedPosture& f) { return t < f.t_s; });
  if (next == postures_.begin()) return postures_.front().posture;
  if (next == postures_.end()) return postures_.back().posture;
  const TimedPosture& before = *std::prev(next);
  Posture posture =
      Mix(before.posture, next->posture, (t_s - before.t_s) / (next->t_s - before.t_s));
  posture.hips_W_m = hips_.At(t_s).X_WH.p_m;
  return posture;
}

}  // namespace prehend::physics
