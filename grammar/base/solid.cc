// SPDX-License-Identifier: Apache-2.0
// Hulls by Wolfe's method (1976, "Finding the nearest point in a polytope"): it keeps few points,
// finds the nearest place between them, and adds the point that lies farthest towards p, until
// there is none.
#include "grammar/base/solid.h"

#include <algorithm>
#include <cmath>

namespace prehend::grammar {
namespace {

using Eigen::Vector3d;

constexpr double kAccuracy_m = 1e-9;

/// Up to four points, and a place between them as their weighted mean.
class Simplex {
 public:
  explicit Simplex(const Vector3d& point) : points_{point}, weights_{1} {}

  Vector3d Place() const {
    Vector3d place = Vector3d::Zero();
    for (std::size_t i = 0; i < points_.size(); ++i) place += weights_[i] * points_[i];
    return place;
  }

  void Add(const Vector3d& point) {
    points_.push_back(point);
    weights_.push_back(0);
  }

  /// Moves the place to the nearest one to the origin, and drops the points that it does not need.
  void MoveNearest() {
    for (;;) {
      const std::vector<double> aims = WeightsOfNearestInSpan();
      // As far towards it as no weight gets negative.
      double way = 1;
      std::size_t first_to_go = points_.size();
      for (std::size_t i = 0; i < points_.size(); ++i) {
        if (aims[i] > 0) continue;
        const double until = weights_[i] > 0 ? weights_[i] / (weights_[i] - aims[i]) : 0;
        if (until < way || first_to_go == points_.size()) way = until, first_to_go = i;
      }
      for (std::size_t i = 0; i < points_.size(); ++i) weights_[i] += way * (aims[i] - weights_[i]);
      if (first_to_go == points_.size()) return;
      points_.erase(points_.begin() + static_cast<std::ptrdiff_t>(first_to_go));
      weights_.erase(weights_.begin() + static_cast<std::ptrdiff_t>(first_to_go));
    }
  }

 private:
  /// Of the nearest place to the origin on the line, on the plane or in the space that the points
  /// span.
  std::vector<double> WeightsOfNearestInSpan() const {
    using Edges = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3>;
    Edges edges(3, static_cast<Eigen::Index>(points_.size()) - 1);
    for (Eigen::Index i = 0; i < edges.cols(); ++i)
      edges.col(i) = points_[static_cast<std::size_t>(i) + 1] - points_[0];
    std::vector<double> weights = {1};
    if (edges.cols() == 0) return weights;
    const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> along =
        edges.colPivHouseholderQr().solve(-points_[0]);
    weights[0] = 1 - along.sum();
    weights.insert(weights.end(), along.begin(), along.end());
    return weights;
  }

  std::vector<Vector3d> points_;
  std::vector<double> weights_;
};

/// Of a point in the frame of the shape; 0 inside.
struct DistanceOf {
  Vector3d p;

  double operator()(const Box& box) const {
    return (p.cwiseAbs() - box.half_size_m).cwiseMax(0).norm();
  }
  double operator()(const Ball& ball) const { return std::max(p.norm() - ball.radius_m, 0.0); }
  double operator()(const Cylinder& cylinder) const {
    return std::hypot(std::max(p.head<2>().norm() - cylinder.radius_m, 0.0),
                      std::max(std::abs(p.z()) - cylinder.half_length_m, 0.0));
  }
  double operator()(const Capsule& capsule) const {
    const double z = std::max(std::abs(p.z()) - capsule.half_length_m, 0.0);
    return std::max(Vector3d(p.x(), p.y(), z).norm() - capsule.radius_m, 0.0);
  }
  double operator()(const Hull& hull) const {
    Simplex simplex(hull.points_m.front() - p);
    double distance = simplex.Place().norm();
    while (distance > kAccuracy_m) {
      const Vector3d to_hull = simplex.Place();
      const Vector3d& nearest = *std::ranges::min_element(
          hull.points_m, {}, [&](const Vector3d& point) { return to_hull.dot(point); });
      if (to_hull.dot(to_hull - (nearest - p)) <= kAccuracy_m * distance) return distance;
      simplex.Add(nearest - p);
      simplex.MoveNearest();
      const double before = distance;
      distance = simplex.Place().norm();
      if (distance >= before) return before;  // no nearer than rounding allows
    }
    return 0;
  }
};

/// The smallest ball around the origin of the shape that holds it.
struct BoundOf {
  double operator()(const Box& box) const { return box.half_size_m.norm(); }
  double operator()(const Ball& ball) const { return ball.radius_m; }
  double operator()(const Cylinder& cylinder) const {
    return std::hypot(cylinder.radius_m, cylinder.half_length_m);
  }
  double operator()(const Capsule& capsule) const {
    return capsule.radius_m + capsule.half_length_m;
  }
  double operator()(const Hull& hull) const {
    double bound = 0;
    for (const Vector3d& point : hull.points_m) bound = std::max(bound, point.norm());
    return bound;
  }
};

}  // namespace

Solid::Solid(std::vector<SolidPart> parts) : parts_(std::move(parts)) {
  for (const SolidPart& part : parts_) bounds_m_.push_back(std::visit(BoundOf{}, part.shape));
}

double Solid::DistanceTo(const Vector3d& p_B_m, double most_m) const {
  double nearest_m = most_m;
  for (std::size_t i = 0; i < parts_.size() && nearest_m > 0; ++i) {
    const Vector3d offset_m = p_B_m - parts_[i].p_BS_m;
    const double farthest_m = nearest_m + bounds_m_[i];
    if (offset_m.squaredNorm() >= farthest_m * farthest_m) continue;
    const Vector3d p_S_m = parts_[i].q_BS.conjugate() * offset_m;
    nearest_m = std::min(nearest_m, std::visit(DistanceOf{p_S_m}, parts_[i].shape));
  }
  return nearest_m;
}

}  // namespace prehend::grammar
