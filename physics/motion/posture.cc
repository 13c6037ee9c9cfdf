// SPDX-License-Identifier: Apache-2.0
// Directions turn along great circles. Tested by tests/physics/motion/posture_test.cc
#include "physics/motion/posture.h"

#include <algorithm>

namespace prehend::physics {
namespace {

Eigen::Vector3d TurnedToward(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double share) {
  const Eigen::Quaterniond whole = RotationBetween(a, b);
  return Eigen::Quaterniond::Identity().slerp(share, whole) * a;
}

Trajectory HipsOf(const std::vector<TimedFigure>& figures) {
  std::vector<TimedPose> poses;
  for (const TimedFigure& timed : figures)
    poses.push_back({.t_s = timed.t_s, .X_WH = {timed.figure.hips_W_m}, .trigger = {}});
  return WaypointTrajectory({}, poses);
}

std::vector<TimedFigure> StartingWith(const Figure& from, std::vector<TimedFigure> figures) {
  if (figures.front().t_s > 0) figures.insert(figures.begin(), {0, from});
  return figures;
}

}  // namespace

Figure Mix(const Figure& a, const Figure& b, double share) {
  Figure mixed{.hips_W_m = a.hips_W_m + share * (b.hips_W_m - a.hips_W_m), .ways_W = {}};
  for (std::size_t i = 0; i < Figure::kWays; ++i)
    mixed.ways_W[i] = TurnedToward(a.ways_W[i], b.ways_W[i], share);
  return mixed;
}

FigureTrack::FigureTrack(const Figure& from, std::vector<TimedFigure> figures)
    : figures_(StartingWith(from, std::move(figures))), hips_(HipsOf(figures_)) {}

Figure FigureTrack::At(double t_s) const {
  const auto next = std::upper_bound(figures_.begin(), figures_.end(), t_s,
                                     [](double t, const TimedFigure& f) { return t < f.t_s; });
  if (next == figures_.begin()) return figures_.front().figure;
  if (next == figures_.end()) return figures_.back().figure;
  const TimedFigure& before = *std::prev(next);
  Figure figure = Mix(before.figure, next->figure, (t_s - before.t_s) / (next->t_s - before.t_s));
  figure.hips_W_m = hips_.At(t_s).X_WH.p_m;
  return figure;
}

}  // namespace prehend::physics
