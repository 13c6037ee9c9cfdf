// SPDX-License-Identifier: Apache-2.0
// Triangle meshes. A vertex is a corner and an outward direction; a mesh is drawn as
//   position = corner * half_size + direction * rounding
// (the Minkowski sum of a solid and a ball), so one unit mesh gives every rounded box, ball,
// capsule or cylinder without distorted bevels. Tested by tests/render/gl/mesh_test.cc
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "physics/scene/scene.h"

namespace prehend::render {

struct Vertex {
  Eigen::Vector3f corner;
  Eigen::Vector3f direction;  ///< unit
};

struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> triangles;  ///< three indices each, counter-clockwise from outside
};

/// Corners at +-1; `segments` per quarter turn of an edge. Half size 0 gives a ball, (0, 0, h) a
/// capsule.
Mesh RoundedBoxMesh(int segments);
/// Unit radius and half length around z, with rounded rims.
Mesh RoundedCylinderMesh(int segments);
/// Base of unit radius at z = 0, tip at z = 1.
Mesh ConeMesh(int segments);
/// Flat faces; corners are the hull's own: draw it with half size 1.
Mesh HullMesh(const physics::Hull& hull);
/// A tube along the points; corners are the points themselves: draw it with half size 1. Empty for
/// fewer than two points.
Mesh TubeMesh(const std::vector<Eigen::Vector3f>& points, int segments);

/// The shortest rotation from one direction to another, as physics::RotationBetween.
Eigen::Quaternionf RotationBetween(const Eigen::Vector3f& from, const Eigen::Vector3f& to);

}  // namespace prehend::render
