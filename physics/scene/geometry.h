// SPDX-License-Identifier: Apache-2.0
// Sizes of shapes and distances to them, as needed to plan motions. No engine involved. Tested by
// tests/physics/scene/geometry_test.cc
#pragma once

#include <vector>

#include "physics/scene/scene.h"

namespace prehend::physics {

/// None if no body has this name.
BodyIndex FindBody(const Scene& scene, const std::string& name);

/// Extent of the body from the centre of its bounding box in a world direction (unit), metres.
double HalfWidthAlong(const LocalBox& box, const Pose& X_WB, const Eigen::Vector3d& direction_W);

/// Width of the body itself in a world direction (unit), metres.
double WidthAlong(const Body& body, const Pose& X_WB, const Eigen::Vector3d& direction_W);

/// Whether the point is inside a body at X_WB: inside its bounding box, or for a region inside the
/// region itself.
bool IsInside(const Body& body, const Pose& X_WB, const Eigen::Vector3d& p_W_m);

/// Bounding box, aligned with the world's axes, of a shape at X_WS, metres.
Eigen::AlignedBox3d WorldBounds(const Shape& shape, const Pose& X_WS);

/// Bounding box, aligned with the world's axes, of a whole body, metres.
Eigen::AlignedBox3d WorldBounds(const Body& body, const Pose& X_WB);

/// A point of the shape that lies farthest in a direction (of any length), both in the shape's
/// frame.
Eigen::Vector3d FarthestAlong(const Shape& shape, const Eigen::Vector3d& n_S);

/// Distance of a point (in the shape's frame) from the surface, metres; negative inside.
double SignedDistance(const Shape& shape, const Eigen::Vector3d& p_S);

/// The part of a body that is nearest to a point in the body's frame.
const PlacedShape& PartAt(const Body& body, const Eigen::Vector3d& p_B_m);

/// Distance of a point (in the body's frame) from the nearest surface, metres; negative inside.
double DistanceTo(const Body& body, const Eigen::Vector3d& p_B_m);

/// Volume, cubic metres.
double VolumeOf(const Shape& shape);

/// Whether the body is rotationally symmetric about the vertical: true for spheres and for upright
/// cylinders and capsules.
bool IsRoundAboutVertical(const Body& body, const Pose& X_WB);

}  // namespace prehend::physics
