// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/penetration_test.cc
#include "harness/penetration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace prehend::harness {
namespace {

using Eigen::Vector3d;

/// Half of the shape's extent along a unit direction given in its own frame. All shapes are symmetric.
struct HalfExtent {
  Vector3d n_S;
  double operator()(const physics::Box& box) const { return n_S.cwiseAbs().dot(box.size_m) / 2; }
  double operator()(const physics::Sphere& sphere) const { return sphere.radius_m; }
  double operator()(const physics::Cylinder& cylinder) const {
    return std::abs(n_S.z()) * cylinder.length_m / 2 + n_S.head<2>().norm() * cylinder.radius_m;
  }
  double operator()(const physics::Capsule& capsule) const {
    return std::abs(n_S.z()) * capsule.length_m / 2 + capsule.radius_m;
  }
};

double HalfExtentAlong(const PlacedSolid& solid, const Vector3d& n_W) {
  return std::visit(HalfExtent{solid.X_WS.q.conjugate() * n_W}, solid.shape);
}

/// The point of the solid's bounding box nearest to `p_W`, for axes that meet a box's corner.
Vector3d NearestInBox(const PlacedSolid& solid, const Vector3d& p_W) {
  Vector3d p_S = solid.X_WS.inverse() * p_W;
  for (int i = 0; i < 3; ++i) {
    const double half = std::visit(HalfExtent{Vector3d::Unit(i)}, solid.shape);
    p_S[i] = std::clamp(p_S[i], -half, half);
  }
  return solid.X_WS * p_S;
}

std::vector<Vector3d> CandidateAxes(const PlacedSolid& a, const PlacedSolid& b) {
  const Eigen::Matrix3d R_a = a.X_WS.q.toRotationMatrix(), R_b = b.X_WS.q.toRotationMatrix();
  const Vector3d between = b.X_WS.p_m - a.X_WS.p_m;
  std::vector<Vector3d> axes = {between, b.X_WS.p_m - NearestInBox(a, b.X_WS.p_m),
                                a.X_WS.p_m - NearestInBox(b, a.X_WS.p_m)};
  for (int i = 0; i < 3; ++i) {
    axes.push_back(R_a.col(i));
    axes.push_back(R_b.col(i));
    for (int j = 0; j < 3; ++j) axes.push_back(R_a.col(i).cross(R_b.col(j)));
  }
  for (const Eigen::Matrix3d& R : {R_a, R_b}) {  // radial directions of round shapes
    axes.push_back(between - R.col(2) * R.col(2).dot(between));
    const Vector3d corner = b.X_WS.p_m - NearestInBox(a, b.X_WS.p_m);
    axes.push_back(corner - R.col(2) * R.col(2).dot(corner));
  }
  return axes;
}

}  // namespace

double Penetration(const PlacedSolid& a, const PlacedSolid& b) {
  constexpr double kTooShortForAnAxis = 1e-6;
  const Vector3d between = b.X_WS.p_m - a.X_WS.p_m;
  double depth = std::numeric_limits<double>::infinity();
  for (const Vector3d& axis : CandidateAxes(a, b)) {
    const double length = axis.norm();
    if (length < kTooShortForAnAxis) continue;
    const Vector3d n = axis / length;
    depth = std::min(depth, HalfExtentAlong(a, n) + HalfExtentAlong(b, n) - std::abs(n.dot(between)));
  }
  return depth;
}

}  // namespace prehend::harness
