// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include "harness/exchange/import/track.h"

namespace prehend::exchange {
namespace {

constexpr double kMost_m_per_s2 = 100, kMost_rad_per_s2 = 600;
constexpr double kLeast_m = 0.015, kLeast_rad = 0.26;  ///< less is noise
constexpr double kFaster = 3;                          ///< than it is before, or afterwards
constexpr double kNothing_m_per_s = 50;  ///< is so fast; what explodes is, and goes on so
constexpr double kComesBack_s = 0.25;
constexpr std::size_t kFewFrames = 5, kNeighbours = 2;
constexpr double kPassing_m = 0.04;  ///< bodies that pass each other do not get so near
constexpr double kSameTime_s = 1e-6;
constexpr double kSamePlace = 0.3;  ///< of the way that it jumps

double Degrees(double rad) { return rad * 180 / static_cast<double>(EIGEN_PI); }

class JumpFinder {
 public:
  explicit JumpFinder(const PoseSeries& poses) : poses_(poses) {}

  JumpsOfTrack Find() {
    JumpsOfTrack found;
    for (std::size_t i = 1; i < poses_.size(); ++i) {
      const bool sets_off = SetsOff(i), stays = Stays(i);
      const bool is_wild = Way_m(i) > std::max(kLeast_m, kNothing_m_per_s * Seconds(i));
      if (!sets_off && !stays && !is_wild) continue;
      if (const auto end = sets_off ? ComesBack(i) : std::nullopt) {
        found.outliers.push_back(OutlierIn(i, *end));
        i = *end;
      } else if (is_wild || (sets_off && stays)) {
        found.jumps.push_back({i, Way_m(i), Degrees(Turn_rad(i))});
      }
    }
    return found;
  }

 private:
  double Seconds(std::size_t i) const { return poses_[i].t_s - poses_[i - 1].t_s; }
  double Way_m(std::size_t i) const { return (poses_[i].p - poses_[i - 1].p).norm(); }
  double Turn_rad(std::size_t i) const { return poses_[i].q.angularDistance(poses_[i - 1].q); }

  /// Whether step i is longer than the steps from `first` up to `last` lead to.
  bool IsSudden(std::size_t i, std::size_t first, std::size_t last) const {
    if (Way_m(i) <= kLeast_m && Turn_rad(i) <= kLeast_rad) return false;  // as most are
    const Speeds usual = FastestOf(first, last);
    const double s = Seconds(i);
    return Way_m(i) > std::max(kLeast_m, kMost_m_per_s2 * s * s) + kFaster * usual.m_per_s * s ||
           Turn_rad(i) >
               std::max(kLeast_rad, kMost_rad_per_s2 * s * s) + kFaster * usual.rad_per_s * s;
  }

  struct Speeds {
    double m_per_s = 0, rad_per_s = 0;
  };
  Speeds FastestOf(std::size_t first, std::size_t last) const {
    Speeds most;
    for (std::size_t k = std::max<std::size_t>(first, 1); k < std::min(last, poses_.size()); ++k) {
      most.m_per_s = std::max(most.m_per_s, Way_m(k) / Seconds(k));
      most.rad_per_s = std::max(most.rad_per_s, Turn_rad(k) / Seconds(k));
    }
    return most;
  }
  bool SetsOff(std::size_t i) const {
    return IsSudden(i, i > kNeighbours ? i - kNeighbours : 0, i);
  }
  bool Stays(std::size_t i) const { return IsSudden(i, i + 1, i + 1 + kNeighbours); }

  /// The first pose that is back where it was before step i.
  std::optional<std::size_t> ComesBack(std::size_t i) const {
    const PoseSample& before = poses_[i - 1];
    const Speeds usual = FastestOf(i > kNeighbours ? i - kNeighbours : 0, i);
    for (std::size_t k = i + 1; k < poses_.size(); ++k) {
      const double s = poses_[k].t_s - before.t_s;
      if (k > i + kFewFrames && s > kComesBack_s) break;
      // Or it has moved on meanwhile.
      const bool is_back =
          (poses_[k].p - before.p).norm() <=
              std::max(kLeast_m, kSamePlace * Way_m(i)) + 2 * usual.m_per_s * s &&
          poses_[k].q.angularDistance(before.q) <=
              std::max(kLeast_rad, kSamePlace * Turn_rad(i)) + 2 * usual.rad_per_s * s;
      if (is_back && Stays(k)) return k;
    }
    return std::nullopt;
  }

  Outlier OutlierIn(std::size_t begin, std::size_t end) const {
    Outlier outlier{begin, end, 0, 0};
    const PoseSample &before = poses_[begin - 1], &after = poses_[end];
    for (std::size_t k = begin; k < end; ++k) {
      const double part = (poses_[k].t_s - before.t_s) / (after.t_s - before.t_s);
      outlier.off_m =
          std::max(outlier.off_m, (poses_[k].p - before.p - part * (after.p - before.p)).norm());
      outlier.off_deg = std::max(
          outlier.off_deg, Degrees(poses_[k].q.angularDistance(before.q.slerp(part, after.q))));
    }
    return outlier;
  }

  const PoseSeries& poses_;
};

}  // namespace

JumpsOfTrack FindJumps(const PoseSeries& poses) { return JumpFinder(poses).Find(); }

std::vector<Exchange> FindExchanges(const std::vector<const PoseSeries*>& tracks,
                                    std::vector<JumpsOfTrack>& found) {
  std::vector<Exchange> exchanges;
  const auto erase = [&](std::size_t body, std::size_t at) {
    std::erase_if(found[body].jumps, [&](const Jump& jump) { return jump.at == at; });
  };
  for (std::size_t a = 0; a < tracks.size(); ++a) {
    const PoseSeries& ours = *tracks[a];
    std::vector<std::pair<std::size_t, double>> leaps;  ///< and their ways
    for (std::size_t i = 1; i < ours.size(); ++i)
      if (const double way_m = (ours[i].p - ours[i - 1].p).norm(); !(way_m < kPassing_m))
        leaps.emplace_back(i, way_m);
    for (std::size_t b = a + 1; b < tracks.size(); ++b) {
      const PoseSeries& theirs = *tracks[b];
      std::vector<double> times_s;
      std::size_t k = 1;
      for (const auto& [i, way_m] : leaps) {
        while (k < theirs.size() && theirs[k].t_s < ours[i].t_s - kSameTime_s) ++k;
        if (k >= theirs.size()) break;
        const double near_m = std::max(kLeast_m, kSamePlace * way_m);
        if (std::abs(theirs[k].t_s - ours[i].t_s) > kSameTime_s ||
            (ours[i].p - theirs[k - 1].p).norm() > near_m ||
            (theirs[k].p - ours[i - 1].p).norm() > near_m)
          continue;
        times_s.push_back(ours[i].t_s);
        erase(a, i);
        erase(b, k);
      }
      // The first begins it, the second ends it.
      for (std::size_t i = 0; i < times_s.size(); i += 2)
        exchanges.push_back(
            {a, b, times_s[i], i + 1 < times_s.size() ? times_s[i + 1] : ours.back().t_s});
      LetGo(theirs);
    }
    LetGo(ours);
  }
  return exchanges;
}

}  // namespace prehend::exchange
