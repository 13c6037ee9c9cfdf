// SPDX-License-Identifier: Apache-2.0
// One visitor per question over the kinds of shapes.
#include "physics/scene/geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/base/visitors.h"

namespace prehend::physics {
namespace {

/// Smallest cosine of the angle to the vertical at which a cylinder counts as upright, about 5
/// degrees.
constexpr double kUprightCosine = 0.996;

/// Half extents, along the axes of a frame, of a shape whose rotation in that frame is R.
struct HalfExtentsIn {
  const Eigen::Matrix3d& R;

  Eigen::Vector3d operator()(const Box& s) const { return R.cwiseAbs() * (s.size_m / 2); }
  Eigen::Vector3d operator()(const Sphere& s) const {
    return Eigen::Vector3d::Constant(s.radius_m);
  }
  Eigen::Vector3d operator()(const Cylinder& s) const {
    const Eigen::Vector3d axis = R.col(2).cwiseAbs();
    const Eigen::Vector3d disc =
        (Eigen::Vector3d::Ones() - axis.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
    return axis * (s.length_m / 2) + disc * s.radius_m;
  }
  Eigen::Vector3d operator()(const Capsule& s) const {
    return R.col(2).cwiseAbs() * (s.length_m / 2) + Eigen::Vector3d::Constant(s.radius_m);
  }
};

/// Bounding box, aligned with the world's axes, of a shape at X_WS.
struct BoundsAt {
  const Pose& X_WS;

  Eigen::AlignedBox3d operator()(const Hull& hull) const {
    Eigen::AlignedBox3d bounds;
    for (const Eigen::Vector3d& corner : hull.corners_m) bounds.extend(X_WS * corner);
    return bounds;
  }
  template <class Symmetric>
  Eigen::AlignedBox3d operator()(const Symmetric& s) const {
    const Eigen::Vector3d half = HalfExtentsIn{X_WS.q.toRotationMatrix()}(s);
    return {Eigen::Vector3d(X_WS.p_m - half), Eigen::Vector3d(X_WS.p_m + half)};
  }
};

struct FarthestPoint {
  const Eigen::Vector3d& n;

  Eigen::Vector3d operator()(const Box& s) const {
    return (n.array() < 0).select(-s.size_m / 2, s.size_m / 2);
  }
  Eigen::Vector3d operator()(const Sphere& s) const { return s.radius_m * n.normalized(); }
  Eigen::Vector3d operator()(const Cylinder& s) const {
    Eigen::Vector3d p_S(0, 0, std::copysign(s.length_m / 2, n.z()));
    p_S.head<2>() = s.radius_m * n.head<2>().normalized();
    return p_S;
  }
  Eigen::Vector3d operator()(const Capsule& s) const {
    return s.radius_m * n.normalized() +
           std::copysign(s.length_m / 2, n.z()) * Eigen::Vector3d::UnitZ();
  }
  Eigen::Vector3d operator()(const Hull& s) const {
    return *std::ranges::max_element(s.corners_m, {},
                                     [&](const Eigen::Vector3d& corner) { return n.dot(corner); });
  }
};

struct VolumeOfShape {
  static constexpr double kPi = std::numbers::pi;

  double operator()(const Box& s) const { return s.size_m.prod(); }
  double operator()(const Sphere& s) const {
    return 4.0 / 3 * kPi * s.radius_m * s.radius_m * s.radius_m;
  }
  double operator()(const Cylinder& s) const { return kPi * s.radius_m * s.radius_m * s.length_m; }
  double operator()(const Capsule& s) const {
    return (*this)(Sphere{s.radius_m}) + (*this)(Cylinder{s.radius_m, s.length_m});
  }
  double operator()(const Hull& s) const { return s.volume_m3; }
};

/// Signed distance of a point from its offsets beyond the half sizes, one per independent
/// direction.
template <int N>
double BeyondHalfSizes(const Eigen::Matrix<double, N, 1>& beyond) {
  return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0);
}

struct DistanceOf {
  const Eigen::Vector3d& p;

  double operator()(const Box& s) const { return BeyondHalfSizes<3>(p.cwiseAbs() - s.size_m / 2); }
  double operator()(const Sphere& s) const { return p.norm() - s.radius_m; }
  double operator()(const Cylinder& s) const {
    return BeyondHalfSizes<2>(
        {std::hypot(p.x(), p.y()) - s.radius_m, std::abs(p.z()) - s.length_m / 2});
  }
  double operator()(const Capsule& s) const {
    const double along = std::clamp(p.z(), -s.length_m / 2, s.length_m / 2);
    return (p - along * Eigen::Vector3d::UnitZ()).norm() - s.radius_m;
  }
  double operator()(const Hull& s) const { return SignedDistance(s, p); }
};

double DistanceTo(const PlacedShape& part, const Eigen::Vector3d& p_B_m) {
  return SignedDistance(part.shape, part.X_BS.inverse() * p_B_m);
}

}  // namespace

BodyIndex FindBody(const Scene& scene, const std::string& name) {
  const auto it = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                               [&](const Body& body) { return body.name == name; });
  return it == scene.bodies.end() ? kNone : BodyIndex(it - scene.bodies.begin());
}

double HalfWidthAlong(const LocalBox& box, const Pose& X_WB, const Eigen::Vector3d& direction_W) {
  return (X_WB.q.conjugate() * direction_W).cwiseAbs().dot(box.half_size_m);
}

Eigen::AlignedBox3d WorldBounds(const Shape& shape, const Pose& X_WS) {
  return std::visit(BoundsAt{X_WS}, shape);
}

Eigen::AlignedBox3d WorldBounds(const Body& body, const Pose& X_WB) {
  Eigen::AlignedBox3d bounds;
  for (const PlacedShape& placed : body.shapes)
    bounds.extend(WorldBounds(placed.shape, X_WB * placed.X_BS));
  return bounds;
}

Eigen::Vector3d FarthestAlong(const Shape& shape, const Eigen::Vector3d& n_S) {
  return std::visit(FarthestPoint{n_S}, shape);
}

double WidthAlong(const Body& body, const Pose& X_WB, const Eigen::Vector3d& direction_W) {
  if (body.shapes.empty()) return 0;
  double least_m = HUGE_VAL, most_m = -HUGE_VAL;
  for (const PlacedShape& placed : body.shapes) {
    const Pose X_WS = X_WB * placed.X_BS;
    const Eigen::Vector3d n_S = X_WS.q.conjugate() * direction_W;
    most_m = std::max(most_m, direction_W.dot(X_WS * FarthestAlong(placed.shape, n_S)));
    least_m = std::min(least_m, direction_W.dot(X_WS * FarthestAlong(placed.shape, -n_S)));
  }
  return most_m - least_m;
}

double SignedDistance(const Shape& shape, const Eigen::Vector3d& p_S) {
  return std::visit(DistanceOf{p_S}, shape);
}

const PlacedShape& PartAt(const Body& body, const Eigen::Vector3d& p_B_m) {
  return *std::min_element(body.shapes.begin(), body.shapes.end(),
                           [&](const PlacedShape& l, const PlacedShape& r) {
                             return DistanceTo(l, p_B_m) < DistanceTo(r, p_B_m);
                           });
}

double DistanceTo(const Body& body, const Eigen::Vector3d& p_B_m) {
  return DistanceTo(PartAt(body, p_B_m), p_B_m);
}

double VolumeOf(const Shape& shape) { return std::visit(VolumeOfShape{}, shape); }

bool IsRoundAboutVertical(const Body& body, const Pose& X_WB) {
  if (body.shapes.size() != 1) return false;
  const PlacedShape& placed = body.shapes.front();
  const Eigen::Vector3d axis_W = (X_WB * placed.X_BS).q * Eigen::Vector3d::UnitZ();
  return std::visit(Overloaded{[](const Sphere&) { return true; },
                               [](const OneOf<Box, Hull> auto&) { return false; },
                               [&](const OneOf<Cylinder, Capsule> auto&) {
                                 return std::abs(axis_W.z()) > kUprightCosine;
                               }},
                    placed.shape);
}

bool IsInside(const Body& body, const Pose& X_WB, const Eigen::Vector3d& p_W_m) {
  if (body.abstract == Abstract::kRegion) return DistanceTo(body, X_WB.inverse() * p_W_m) <= 0;
  const LocalBox box = BoundingBox(body);
  const Eigen::Vector3d away_m = (X_WB.inverse() * p_W_m - box.p_BC_m).cwiseAbs();
  return (away_m.array() <= box.half_size_m.array()).all();
}

LocalBox BoundingBox(const Body& body) {
  const Eigen::AlignedBox3d bounds = WorldBounds(body, Pose{});
  if (bounds.isEmpty()) return {};
  return {bounds.center(), bounds.sizes() / 2};
}

}  // namespace prehend::physics
