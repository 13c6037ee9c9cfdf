// SPDX-License-Identifier: Apache-2.0
// Convex hulls: a solid of flat faces, given by its corners. No engine involved. Faces come from
// all planes through three points that have no point outside, which is exact and quick enough for
// 64 points. Tested by tests/physics/scene/hull_test.cc
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "physics/scene/pose.h"

namespace prehend::physics {

/// A solid of even density. All in the frame S in which its points were given.
struct Hull {
  struct Face {
    std::vector<int> corners;  ///< indices into corners_m, counter-clockwise from outside
    Eigen::Vector3d nhat_S = Eigen::Vector3d::UnitZ();  ///< outwards
    double offset_m = 0;  ///< of the face's plane from the origin, along nhat_S
  };
  std::vector<Eigen::Vector3d> corners_m;
  std::vector<Face> faces;
  double volume_m3 = 0;
  Pose X_SC;  ///< centre of mass and principal axes
  Eigen::Vector3d gyration_m2 =
      Eigen::Vector3d::Zero();  ///< moments of inertia about the axes of C, per mass
};

inline constexpr int kFewestHullPoints = 4;
inline constexpr int kMostHullPoints = 64;
/// Points nearer than this are one; a solid thinner than this is none.
inline constexpr double kNearestHullPoints_m = 1e-4;
inline constexpr double kThinnestHull_m = 1e-3;

/// A hull, or why there is none.
struct MadeHull {
  std::optional<Hull> hull;
  int point = -1;  ///< the one that is wrong; -1: all of them together
  std::string problem, remedy;
};
/// Every point has to be a corner. As many as kFewestHullPoints to kMostHullPoints.
MadeHull MakeHull(const std::vector<Eigen::Vector3d>& points_m);

/// The nearest point of the solid, itself inside of it.
Eigen::Vector3d NearestIn(const Hull& hull, const Eigen::Vector3d& p_S);

/// Of a point from the surface: negative inside. Metres.
double SignedDistance(const Hull& hull, const Eigen::Vector3d& p_S);

/// Directions of all edges, each once.
std::vector<Eigen::Vector3d> EdgesOf(const Hull& hull);

}  // namespace prehend::physics
