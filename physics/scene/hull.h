// SPDX-License-Identifier: Apache-2.0
// Convex hulls: solids with flat faces, given by their corners. No engine involved. Faces come from
// all planes through three points that have no point outside; this is exact, and fast enough for 64
// points. Tested by tests/physics/scene/hull_test.cc
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "physics/base/pose.h"

namespace prehend::physics {

/// A solid of uniform density. All values are in the frame S in which its points were given.
struct Hull {
  struct Face {
    std::vector<int> corners;  ///< indices into corners_m, counter-clockwise from outside
    Eigen::Vector3d nhat_S = Eigen::Vector3d::UnitZ();  ///< outwards
    double offset_m = 0;  ///< distance of the face's plane from the origin, along nhat_S
  };
  std::vector<Eigen::Vector3d> corners_m;
  std::vector<Face> faces;
  double volume_m3 = 0;
  Pose X_SC;  ///< centre of mass and principal axes
  Eigen::Vector3d gyration_m2 =
      Eigen::Vector3d::Zero();  ///< moments of inertia about the axes of C, per mass
};

inline constexpr int kMinHullPoints = 4;
inline constexpr int kMaxHullPoints = 64;
/// Points nearer to each other than this count as one; a solid thinner than this is refused.
inline constexpr double kMinHullPointDistance_m = 1e-4;
inline constexpr double kMinHullThickness_m = 1e-3;

/// A hull, or the reason why there is none.
struct MadeHull {
  std::optional<Hull> hull;
  int point = -1;  ///< index of the wrong point; -1: the points as a whole
  std::string problem, remedy;
};
/// Every point must be a corner; kMinHullPoints to kMaxHullPoints of them.
MadeHull MakeHull(const std::vector<Eigen::Vector3d>& points_m);

/// The nearest point of the solid; the point itself if it is inside.
Eigen::Vector3d NearestIn(const Hull& hull, const Eigen::Vector3d& p_S);

/// Distance of a point from the surface, metres; negative inside.
double SignedDistance(const Hull& hull, const Eigen::Vector3d& p_S);

/// Directions (unit) of all edges, without repetition.
std::vector<Eigen::Vector3d> EdgesOf(const Hull& hull);

}  // namespace prehend::physics
