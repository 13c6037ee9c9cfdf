// SPDX-License-Identifier: Apache-2.0
// One visitor per question over the kinds of shapes. Tested by tests/physics/scene/geometry_test.cc
#include "physics/scene/geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prehend::physics {
namespace {

/// Smallest cosine of the angle to the vertical at which a cylinder counts as upright, about 5
/// degrees.
constexpr double kUprightCosine = 0.996;

/// Largest error of the vertical component of an upright support's z axis.
constexpr double kUprightError = 1e-9;

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

}  // namespace

int FindBody(const Scene& scene, const std::string& name) {
  const auto it = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                               [&](const Body& body) { return body.name == name; });
  return it == scene.bodies.end() ? -1 : static_cast<int>(it - scene.bodies.begin());
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

double HighestBelow(const Body& support, const Pose& X_WS, const Body& object, const Pose& X_WO) {
  // A part that overlaps the object by this much still counts as below it.
  constexpr double kOverlap_m = 0.005;
  const bool upright = std::abs((X_WS.q * Eigen::Vector3d::UnitZ()).z() - 1) < kUprightError;
  // Footprints are compared in the support's own axes if it stands upright: in the world's axes the
  // walls of a rotated tray would seem thick.
  const Pose X_WA = upright ? Pose{Eigen::Vector3d::Zero(), X_WS.q} : Pose{};
  const Eigen::AlignedBox3d bounds = WorldBounds(object, X_WA.inverse() * X_WO);
  double top = -HUGE_VAL;
  for (const PlacedShape& placed : support.shapes) {
    const Eigen::AlignedBox3d part = WorldBounds(placed.shape, X_WA.inverse() * X_WS * placed.X_BS);
    const Eigen::AlignedBox3d shared = part.intersection(bounds);
    const bool beneath = shared.min().x() < shared.max().x() && shared.min().y() < shared.max().y();
    if (beneath && part.max().z() <= bounds.min().z() + kOverlap_m)
      top = std::max(top, part.max().z());
  }
  return std::isfinite(top) ? top : WorldBounds(support, X_WS).max().z();
}

double SignedDistance(const Shape& shape, const Eigen::Vector3d& p_S) {
  return std::visit(DistanceOf{p_S}, shape);
}

namespace {

double DistanceTo(const PlacedShape& part, const Eigen::Vector3d& p_B_m) {
  return SignedDistance(part.shape, part.X_BS.inverse() * p_B_m);
}

}  // namespace

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
  if (std::holds_alternative<Sphere>(placed.shape)) return true;
  if (std::holds_alternative<Box>(placed.shape) || std::holds_alternative<Hull>(placed.shape))
    return false;
  return std::abs(((X_WB * placed.X_BS).q * Eigen::Vector3d::UnitZ()).z()) > kUprightCosine;
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
