// SPDX-License-Identifier: Apache-2.0
// The vertical distance of two convex solids is where the vertical through the origin meets the
// lower side of their Minkowski difference. That is a linear program whose columns are pairs of
// points of the solids; the simplex method generates them by need (Dantzig & Wolfe 1960).
#include "physics/scene/landing.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "physics/scene/geometry.h"

namespace prehend::physics {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// A part that overlaps the object by this much still counts as below it.
constexpr double kOverlap_m = 0.005;
/// A landing this much lower than on a level surface is one on a level surface: the difference
/// comes from rounding.
constexpr double kLevel_m = 1e-7;
/// The vertical does not pass through the origin, where it would meet edges and corners of whatever
/// is centred, but this far beside it.
const Vector2d kBeside_m(1.7e-9, 2.3e-9);
/// No better column, and no more of them: round solids have infinitely many.
constexpr double kGain_m = 1e-8;
constexpr int kMaxColumns = 200;

/// A point of the Minkowski difference, as seen from the vertical.
using Column = Vector3d;

/// How high `upper` is above `lower`, straight down, metres; negative if they overlap; none if not
/// even their shadows do. Each is a function from a direction to its farthest point in it.
template <class Upper, class Lower>
std::optional<double> HeightAbove(const Upper& upper, const Lower& lower) {
  const auto column_along = [&](const Vector3d& n) -> Column {
    Column column = upper(n) - lower(-n);
    column.head<2>() -= kBeside_m;
    return column;
  };
  // Three columns that nothing real has surround the vertical at first, farther out and higher than
  // any scene (100 m). The plane through the three is lowered as long as a column lies below it.
  constexpr double kFar_m = 1e3, kHigh_m = 1e8;
  std::array<Column, 3> basis = {Column(kFar_m, 0, kHigh_m), Column(-kFar_m, kFar_m, kHigh_m),
                                 Column(-kFar_m, -kFar_m, kHigh_m)};
  std::array<bool, 3> real = {false, false, false};
  for (int i = 0; i < kMaxColumns; ++i) {
    Vector3d up = (basis[1] - basis[0]).cross(basis[2] - basis[0]);
    if (up.z() == 0) break;
    up /= up.z();
    const Column entering = column_along(-up);
    const auto known = static_cast<std::size_t>(std::ranges::find(real, true) - real.begin());
    if (up.dot(basis[known % 3] - entering) < kGain_m) break;
    // The column that leaves is the one whose weight is used up first.
    Eigen::Matrix3d corners;
    for (int k = 0; k < 3; ++k) corners.col(k) << basis[k].head<2>(), 1;
    const Eigen::PartialPivLU<Eigen::Matrix3d> solver(corners);
    const Vector3d weights = solver.solve(Vector3d(0, 0, 1));
    const Vector3d shares = solver.solve(Vector3d(entering.x(), entering.y(), 1));
    int leaving = -1;
    for (int k = 0; k < 3; ++k) {
      if (shares[k] > 0 &&
          (leaving < 0 || weights[k] * shares[leaving] < weights[leaving] * shares[k]))
        leaving = k;
    }
    if (leaving < 0) break;
    basis[static_cast<std::size_t>(leaving)] = entering;
    real[static_cast<std::size_t>(leaving)] = true;
  }
  if (!std::ranges::all_of(real, [](bool r) { return r; })) return std::nullopt;
  const Vector3d normal = (basis[1] - basis[0]).cross(basis[2] - basis[0]);
  return normal.dot(basis[0]) / normal.z();
}

/// Of a shape in the world.
struct Farthest {
  const Shape& shape;
  const Pose X_WS;
  Vector3d operator()(const Vector3d& n_W) const {
    return X_WS * FarthestAlong(shape, X_WS.q.conjugate() * n_W);
  }
};

bool ShadowsMeet(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) {
  const Eigen::AlignedBox3d shared = a.intersection(b);
  return shared.min().x() < shared.max().x() && shared.min().y() < shared.max().y();
}

}  // namespace

std::optional<double> LandingHeight(const Body& support, const Pose& X_WS, const Body& object,
                                    const Pose& X_WO) {
  const double lowest_m = WorldBounds(object, X_WO).min().z();
  std::optional<double> landing_m;
  for (const PlacedShape& below : support.shapes) {
    const Farthest lower{below.shape, X_WS * below.X_BS};
    const Eigen::AlignedBox3d lower_bounds = WorldBounds(below.shape, lower.X_WS);
    const double top_m = lower_bounds.max().z();
    for (const PlacedShape& above : object.shapes) {
      const Farthest upper{above.shape, X_WO * above.X_BS};
      if (!ShadowsMeet(lower_bounds, WorldBounds(above.shape, upper.X_WS))) continue;
      const std::optional<double> height_m = HeightAbove(upper, lower);
      if (!height_m || *height_m < -kOverlap_m) continue;
      double here_m = lowest_m - *height_m;
      if (std::abs(here_m - top_m) < kLevel_m) here_m = top_m;
      landing_m = std::max(landing_m.value_or(here_m), here_m);
    }
  }
  return landing_m;
}

std::optional<Pose> RestOn(const Body& support, const Pose& X_WS, const Body& object,
                           const Pose& X_WO) {
  const std::optional<double> landing_m = LandingHeight(support, X_WS, object, X_WO);
  if (!landing_m) return std::nullopt;
  Pose standing = X_WO;
  standing.p_m.z() += *landing_m - WorldBounds(object, X_WO).min().z();
  return standing;
}

bool IsAbove(const Body& support, const Pose& X_WS, const Vector2d& p_W_m) {
  const auto point = [&](const Vector3d&) { return Vector3d(p_W_m.x(), p_W_m.y(), 0); };
  const auto solid = [&](const Vector3d& n_W) {
    Vector3d farthest = Vector3d::Zero();
    double reach_m = -HUGE_VAL;
    for (const PlacedShape& part : support.shapes) {
      const Vector3d p_W = Farthest{part.shape, X_WS * part.X_BS}(n_W);
      if (p_W.dot(n_W) <= reach_m) continue;
      farthest = p_W;
      reach_m = p_W.dot(n_W);
    }
    return farthest;
  };
  return HeightAbove(point, solid).has_value();
}

}  // namespace prehend::physics
