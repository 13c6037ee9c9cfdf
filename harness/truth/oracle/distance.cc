// SPDX-License-Identifier: Apache-2.0
// Distances between convex shapes are found by alternating projections (Cheney & Goldstein 1959):
// the nearest point of one shape to the nearest point of the other to ... converges to a nearest
// pair. It needs nothing but the nearest point of a shape, and a hundredth of a millimetre is
// plenty here.
#include <algorithm>
#include <limits>

#include "harness/truth/oracle/evidence.h"

namespace prehend::truth {

namespace {

constexpr int kMaxProjections = 200;
constexpr double kProjectionAccuracy_m = 1e-5;

using Eigen::Vector3d;

Vector3d PulledInto(double radius, const Vector3d& centre, const Vector3d& p) {
  const Vector3d out = p - centre;
  const double distance = out.norm();
  return distance > radius ? Vector3d(centre + out * (radius / distance)) : p;
}

/// The nearest point of a solid shape to p, all in the shape's frame.
struct Nearest {
  Vector3d p;

  Vector3d operator()(const physics::Box& box) const {
    return p.cwiseMax(-box.size_m / 2).cwiseMin(box.size_m / 2);
  }
  Vector3d operator()(const physics::Sphere& sphere) const {
    return PulledInto(sphere.radius_m, Vector3d::Zero(), p);
  }
  Vector3d operator()(const physics::Cylinder& cylinder) const {
    const double half = cylinder.length_m / 2;
    Vector3d near = PulledInto(cylinder.radius_m, {0, 0, p.z()}, p);
    near.z() = std::clamp(p.z(), -half, half);
    return near;
  }
  Vector3d operator()(const physics::Capsule& capsule) const {
    const double half = capsule.length_m / 2;
    return PulledInto(capsule.radius_m, {0, 0, std::clamp(p.z(), -half, half)}, p);
  }
  Vector3d operator()(const physics::Hull& hull) const { return physics::NearestIn(hull, p); }
};

struct Solid {
  physics::Shape shape;
  physics::Pose X_WS;

  Vector3d NearestTo(const Vector3d& p_W) const {
    return X_WS * std::visit(Nearest{X_WS.inverse() * p_W}, shape);
  }
};

double Distance(const Solid& a, const Solid& b) {
  Vector3d on_b = b.X_WS.p_m;
  double distance = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMaxProjections; ++i) {
    const Vector3d on_a = a.NearestTo(on_b);
    on_b = b.NearestTo(on_a);
    const double closer = (on_a - on_b).norm();
    if (distance - closer < kProjectionAccuracy_m) return closer;
    distance = closer;
  }
  return distance;
}

std::vector<Solid> PartsOf(const physics::HandModel& model, const physics::HandState& hand) {
  std::vector<Solid> parts = {{physics::Box{model.palm_size_m}, hand.palm.X_WB}};
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const physics::HandLink& link = model.links[i];
    const Vector3d size(link.length_m, 2 * link.half_width_m, 2 * link.half_thickness_m);
    parts.push_back({physics::Box{size}, hand.X_WL[i]});
  }
  return parts;
}

}  // namespace

double SurfaceDistance(const physics::HandModel& model, const physics::HandState& hand,
                       const physics::Body& body, const physics::BodyState& state) {
  double distance = std::numeric_limits<double>::infinity();
  for (const Solid& part : PartsOf(model, hand))
    for (const physics::PlacedShape& placed : body.shapes)
      distance = std::min(distance, Distance(part, {placed.shape, state.X_WB * placed.X_BS}));
  return distance;
}

double PointDistance(const Vector3d& p_W_m, const physics::Body& body,
                     const physics::BodyState& state) {
  double distance = std::numeric_limits<double>::infinity();
  for (const physics::PlacedShape& placed : body.shapes) {
    const Solid solid{placed.shape, state.X_WB * placed.X_BS};
    distance = std::min(distance, (p_W_m - solid.NearestTo(p_W_m)).norm());
  }
  return distance;
}

}  // namespace prehend::truth
