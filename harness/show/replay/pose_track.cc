// SPDX-License-Identifier: Apache-2.0
#include "harness/show/replay/pose_track.h"

#include <algorithm>

namespace prehend::show {
namespace {

using physics::Pose;

bool IsNear(const Pose& a, const Pose& b) {
  return (a.p_m - b.p_m).squaredNorm() <= kTrackTolerance_m * kTrackTolerance_m &&
         a.q.angularDistance(b.q) <= kTrackTolerance_rad;
}

/// Whether all poses strictly between two of them are near to what is interpolated.
bool Fits(std::span<const Pose> poses, std::span<const std::int64_t> at, std::size_t first,
          std::size_t last) {
  for (std::size_t i = first + 1; i < last; ++i) {
    const double share =
        static_cast<double>(at[i] - at[first]) / static_cast<double>(at[last] - at[first]);
    if (!IsNear(poses[i], Between(poses[first], poses[last], share))) return false;
  }
  return true;
}

}  // namespace

Pose Between(const Pose& a, const Pose& b, double share) {
  return {a.p_m + share * (b.p_m - a.p_m), a.q.slerp(share, b.q)};
}

std::vector<std::size_t> KeysOf(std::span<const Pose> poses, std::span<const std::int64_t> at) {
  if (poses.empty()) return {};
  std::vector<std::size_t> keys = {0};
  const auto differs = [&](const Pose& pose) { return !IsNear(pose, poses.front()); };
  if (std::ranges::none_of(poses, differs)) return keys;
  while (keys.back() + 1 < poses.size()) {
    // As far as doubled steps lead, then between the last that fits and the first that does not.
    const std::size_t from = keys.back();
    std::size_t good = from + 1, step = 1, bad = poses.size();
    while (good + step < poses.size() && Fits(poses, at, from, good + step)) {
      good += step;
      step *= 2;
    }
    bad = std::min(bad, good + step);
    while (bad - good > 1) {
      const std::size_t middle = good + (bad - good) / 2;
      (Fits(poses, at, from, middle) ? good : bad) = middle;
    }
    keys.push_back(good);
  }
  return keys;
}

}  // namespace prehend::show
