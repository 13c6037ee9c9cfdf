// SPDX-License-Identifier: Apache-2.0
// Flood fill of one lattice layer after the other.
#include "physics/scene/fill_vessel.h"

#include <deque>
#include <numbers>
#include <set>
#include <utility>

#include "physics/base/random.h"
#include "physics/scene/geometry.h"

namespace prehend::physics {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Gap between grains as a share of their diameter, so that none starts inside another.
constexpr double kGap = 0.02;
/// Each grain is shifted by at most this share of the gap.
constexpr double kShake = 0.2;
/// Accuracy of the floor's height, as a share of a radius.
constexpr double kFloorStep = 0.05;

class Filling {
 public:
  Filling(const Body& vessel, double radius_m, std::size_t count, std::uint64_t seed)
      : vessel_(vessel),
        box_(BoundingBox(vessel)),
        radius_m_(radius_m),
        count_(count),
        step_m_(2 * radius_m * (1 + kGap)),
        random_(seed),
        turn_(random_.Between(0, std::numbers::pi / 2)) {}

  std::vector<Vector3d> Fill() {
    const double rim_m = box_.p_BC_m.z() + box_.half_size_m.z();
    double z = box_.p_BC_m.z() - box_.half_size_m.z();
    if (IsClear({0, 0, z})) return {};  // the vessel has no floor
    while (z < rim_m && !IsClear({0, 0, z})) z += kFloorStep * radius_m_;
    bool shifted = false;
    while (z < rim_m && grains_.size() < count_ && FillLayer(z, shifted)) {
      z += step_m_ / std::numbers::sqrt2;
      shifted = !shifted;
    }
    return std::move(grains_);
  }

 private:
  bool IsClear(const Vector3d& p_B_m) const { return DistanceTo(vessel_, p_B_m) >= radius_m_; }

  bool IsOver(const Vector3d& p_B_m) const {
    const Vector2d away = (p_B_m - box_.p_BC_m).head<2>().cwiseAbs();
    return (away.array() < box_.half_size_m.head<2>().array()).all();
  }

  Vector3d At(const std::pair<int, int>& cell, double z, bool shifted) const {
    const double shift = shifted ? 0.5 : 0;
    const Vector2d p = step_m_ * (turn_ * Vector2d(cell.first + shift, cell.second + shift));
    return {p.x(), p.y(), z};
  }

  Vector3d Shaken(const Vector3d& p_B_m) {
    const double most_m = kShake * kGap * radius_m_;
    const double x = random_.Between(-most_m, most_m);
    return p_B_m + Vector3d(x, random_.Between(-most_m, most_m), 0);
  }

  /// False if the layer leaks.
  bool FillLayer(double z, bool shifted) {
    std::vector<Vector3d> layer;
    std::deque<std::pair<int, int>> next = {{0, 0}};
    std::set<std::pair<int, int>> seen = {{0, 0}};
    while (!next.empty() && grains_.size() + layer.size() < count_) {
      const auto cell = next.front();
      next.pop_front();
      const Vector3d p_B_m = At(cell, z, shifted);
      if (!IsClear(p_B_m)) continue;  // in the wall, or against it from outside
      if (!IsOver(p_B_m)) return false;
      layer.push_back(Shaken(p_B_m));
      for (const auto& [dx, dy] :
           {std::pair(1, 0), std::pair(0, 1), std::pair(-1, 0), std::pair(0, -1)}) {
        const std::pair neighbour(cell.first + dx, cell.second + dy);
        if (seen.insert(neighbour).second) next.push_back(neighbour);
      }
    }
    grains_.insert(grains_.end(), layer.begin(), layer.end());
    return true;
  }

  const Body& vessel_;
  const LocalBox box_;
  const double radius_m_;
  const std::size_t count_;
  const double step_m_;
  Random random_;
  const Eigen::Rotation2Dd turn_;
  std::vector<Vector3d> grains_;
};

}  // namespace

std::vector<Vector3d> FillVessel(const Body& vessel, double radius_m, int count,
                                 std::uint64_t seed) {
  return Filling(vessel, radius_m, static_cast<std::size_t>(count), seed).Fill();
}

}  // namespace prehend::physics
