// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/resolve/penetration_test.cc
#include "harness/scenario/resolve/penetration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "physics/scene/geometry.h"

namespace prehend::scenario {
namespace {

using Eigen::Vector3d;

double ReachOf(const physics::Shape& shape, const Vector3d& n_S) {
  return n_S.dot(physics::FarthestAlong(shape, n_S));
}

/// How far it reaches along a unit direction, from its own origin.
double ReachAlong(const PlacedSolid& solid, const Vector3d& n_W) {
  return ReachOf(solid.shape, solid.X_WS.q.conjugate() * n_W);
}

/// The point of the solid's bounding box nearest to `p_W`, for axes that meet a box's corner.
Vector3d NearestInBox(const PlacedSolid& solid, const Vector3d& p_W) {
  Vector3d p_S = solid.X_WS.inverse() * p_W;
  for (int i = 0; i < 3; ++i) {
    const double least = -ReachOf(solid.shape, -Vector3d::Unit(i));
    p_S[i] = std::clamp(p_S[i], least, ReachOf(solid.shape, Vector3d::Unit(i)));
  }
  return solid.X_WS * p_S;
}

/// The directions of the edges of a hull; of other shapes their axes.
std::vector<Vector3d> EdgesOf(const PlacedSolid& solid) {
  const auto* hull = std::get_if<physics::Hull>(&solid.shape);
  std::vector<Vector3d> edges =
      hull ? physics::EdgesOf(*hull)
           : std::vector<Vector3d>{Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
  for (Vector3d& edge : edges) edge = solid.X_WS.q * edge;
  return edges;
}

/// What can separate hulls, beyond what can separate boxes.
void AddAxesOfHulls(const PlacedSolid& a, const PlacedSolid& b, std::vector<Vector3d>& axes) {
  bool any = false;
  for (const PlacedSolid* solid : {&a, &b}) {
    const auto* hull = std::get_if<physics::Hull>(&solid->shape);
    if (!hull) continue;
    any = true;
    for (const auto& face : hull->faces) axes.push_back(solid->X_WS.q * face.nhat_S);
    const Vector3d other_W = (solid == &a ? b : a).X_WS.p_m;
    axes.push_back(other_W -
                   solid->X_WS * physics::NearestIn(*hull, solid->X_WS.inverse() * other_W));
  }
  if (!any) return;
  const std::vector<Vector3d> edges_b = EdgesOf(b);
  for (const Vector3d& edge_a : EdgesOf(a))
    for (const Vector3d& edge_b : edges_b) axes.push_back(edge_a.cross(edge_b));
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
  AddAxesOfHulls(a, b, axes);
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
    for (const Vector3d& way : {n, Vector3d(-n)})
      depth = std::min(depth, ReachAlong(a, way) + ReachAlong(b, -way) - way.dot(between));
    if (depth <= 0) return depth;
  }
  return depth;
}

}  // namespace prehend::scenario
