// SPDX-License-Identifier: Apache-2.0
#include "harness/exchange/import/track.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "harness/exchange/doubts/motion_seen.h"

namespace prehend::exchange {
namespace {

/// The poses from `begin` on, up to where it is lost.
std::size_t EndOfSight(const PoseSeries& poses, std::size_t begin) {
  std::size_t end = begin + 1;
  while (end < poses.size() && !poses[end].after_loss) ++end;
  return end;
}

/// How far a pose is off the polynomial of degree `order` - 1 through as many of its neighbours, as
/// the standard deviation that noise on each axis would have: half of all are below that times the
/// median of a chi distribution of three axes. Of the slowest quarter: what is fast bends more.
double OffNeighbours_m(const PoseSeries& poses, std::size_t order) {
  constexpr double kMedianOfThree = 1.538;
  std::vector<std::pair<double, double>> of_way;
  of_way.reserve(poses.size());
  for (std::size_t last = order; last < poses.size(); ++last) {
    const std::span<const PoseSample> some(&poses[last - order], order + 1);
    if (std::ranges::any_of(some.subspan(1), &PoseSample::after_loss)) continue;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double squares = 0;
    for (const PoseSample& pose : some) {
      double weight = 1;
      for (const PoseSample& other : some) {
        if (&other != &pose)
          weight *= (some.back().t_s - some.front().t_s) / (pose.t_s - other.t_s);
      }
      sum += weight * pose.p;
      squares += weight * weight;
    }
    of_way.emplace_back((some.back().p - some.front().p).norm(), sum.norm() / std::sqrt(squares));
  }
  const std::size_t slow = (of_way.size() + 3) / 4;
  std::ranges::nth_element(of_way, of_way.begin() + static_cast<std::ptrdiff_t>(slow));
  std::vector<double> off;
  for (std::size_t i = 0; i < slow; ++i) off.push_back(of_way[i].second);
  return Median(std::move(off)) / kMedianOfThree;
}

}  // namespace

bool IsLost(const Track& track, double t_s) {
  if (track.next == 0) return track.lost_before;
  if (track.poses[track.next - 1].t_s >= t_s) return false;
  return track.next == track.poses.size() ? track.lost_after : track.poses[track.next].after_loss;
}

PoseSeries Smoothed(const PoseSeries& poses, double half_s) {
  PoseSeries smooth = poses;
  for (std::size_t begin = 0; begin < poses.size(); begin = EndOfSight(poses, begin)) {
    const std::size_t end = EndOfSight(poses, begin);
    for (std::size_t i = begin, first = begin; i < end; ++i) {
      const double t_s = poses[i].t_s;
      const double to_end_s = std::min(t_s - poses[begin].t_s, poses[end - 1].t_s - t_s);
      const double reach_s = std::min(half_s, to_end_s) + 1e-9;
      while (poses[first].t_s < t_s - half_s - 1e-9) ++first;
      Eigen::Vector3d p = Eigen::Vector3d::Zero();
      Eigen::Vector4d q = Eigen::Vector4d::Zero();
      double count = 0;
      for (std::size_t k = first; k < end && poses[k].t_s <= t_s + reach_s; ++k) {
        if (poses[k].t_s < t_s - reach_s) continue;
        p += poses[k].p;
        const double sign = poses[k].q.dot(poses[i].q) < 0 ? -1 : 1;
        q += sign * poses[k].q.coeffs();
        ++count;
      }
      smooth[i].p = p / count;
      smooth[i].q = Eigen::Quaterniond(q.normalized());
    }
  }
  return smooth;
}

double WayOf(const PoseSeries& poses) {
  double way = 0;
  for (const int axis : {0, 1, 2}) {
    std::vector<double> at;
    for (const PoseSample& pose : poses) at.push_back(pose.p[axis]);
    std::ranges::sort(at);
    way = std::max(way, at[at.size() * 39 / 40] - at[at.size() / 40]);
  }
  return way;
}

double Trembling_m(const PoseSeries& poses) {
  constexpr double kOfTrembling = 3.2;  // largest share of both that such repetition has
  const double bends_m = OffNeighbours_m(poses, 2), rough_m = OffNeighbours_m(poses, 6);
  return bends_m < kOfTrembling * rough_m ? bends_m : rough_m;
}

}  // namespace prehend::exchange
