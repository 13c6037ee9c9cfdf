// SPDX-License-Identifier: Apache-2.0
// The true shape of an entity, as convex parts, and how far a point is from it. Tested by
// tests/grammar/base/solid_test.cc
#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <variant>
#include <vector>

namespace prehend::grammar {

/// Convex shapes, each in a frame S of its own, whose origin is at its centre; a hull's may be
/// anywhere.
struct Box {
  Eigen::Vector3d half_size_m = Eigen::Vector3d::Zero();
};
struct Ball {
  double radius_m = 0;
};
struct Cylinder {  ///< axis along z
  double radius_m = 0;
  double half_length_m = 0;
};
struct Capsule {  ///< axis along z; length without the caps
  double radius_m = 0;
  double half_length_m = 0;
};
struct Hull {  ///< the convex solid around these points
  std::vector<Eigen::Vector3d> points_m;
};
using Shape = std::variant<Box, Ball, Cylinder, Capsule, Hull>;

/// A shape at its place in the frame B of an entity.
struct SolidPart {
  Shape shape;
  Eigen::Vector3d p_BS_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_BS = Eigen::Quaterniond::Identity();
};

/// All points of some parts, in the frame B of their entity.
class Solid {
 public:
  Solid() = default;
  explicit Solid(std::vector<SolidPart> parts);

  bool IsEmpty() const { return parts_.empty(); }
  const std::vector<SolidPart>& parts() const { return parts_; }

  /// Of a point, metres, within a nanometre; 0 inside. `most_m` if it is farther than that: those
  /// who look for the smallest of many distances save time with it.
  double DistanceTo(const Eigen::Vector3d& p_B_m,
                    double most_m = std::numeric_limits<double>::infinity()) const;

 private:
  std::vector<SolidPart> parts_;
  std::vector<double> bounds_m_;  ///< for each part: it lies in this ball around its origin
};

// How a point lies to a region of the language. Tested by tests/grammar/values/signals_test.cc

/// How far something is from the centre of a region, and how far it may be. For a sphere, the
/// height does not count.
struct Reach {
  double distance_m = 0;
  double radius_m = 0;
  double height_m = 0;
  double most_height_m = 0;
  bool IsInside() const { return distance_m <= radius_m && height_m <= most_height_m; }
};

}  // namespace prehend::grammar
