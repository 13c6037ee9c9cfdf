// SPDX-License-Identifier: Apache-2.0
// Sizes of and distances to the shapes of a scene, as needed to plan motions. No engine involved.
// Tested by tests/physics/scene/geometry_test.cc
#pragma once

#include <vector>

#include "physics/scene/scene.h"

namespace prehend::physics {

/// Index into Scene::bodies; -1: there is none.
int FindBody(const Scene& scene, const std::string& name);

/// How far the body reaches from its bounding box' centre in a world direction (unit), metres.
double HalfWidthAlong(const LocalBox& box, const Pose& X_WB, const Eigen::Vector3d& direction_W);

/// Is the point in the body that stands at X_WB: in its bounding box, of a region in the region
/// itself?
bool IsInside(const Body& body, const Pose& X_WB, const Eigen::Vector3d& p_W_m);

/// World axes-aligned box of a shape that stands at X_WS.
Eigen::AlignedBox3d WorldBounds(const Shape& shape, const Pose& X_WS);

/// World axes-aligned box of a whole body, metres.
Eigen::AlignedBox3d WorldBounds(const Body& body, const Pose& X_WB);

/// Height of what carries an object that stands at X_WO: the highest part of `support` that lies
/// below it. The top of the whole support when no part does.
double HighestBelow(const Body& support, const Pose& X_WS, const Body& object, const Pose& X_WO);

/// Distance of a point, in the shape's frame, from the surface: negative inside. Metres.
double SignedDistance(const Shape& shape, const Eigen::Vector3d& p_S);

/// The part of a body, in its own frame, that is nearest to a point.
const PlacedShape& PartAt(const Body& body, const Eigen::Vector3d& p_B_m);

/// Distance of a point, in the body's frame, from the nearest surface: negative inside. Metres.
double DistanceTo(const Body& body, const Eigen::Vector3d& p_B_m);

/// Cubic metres.
double VolumeOf(const Shape& shape);

/// Do all horizontal directions look the same? True for spheres and for upright cylinders and
/// capsules.
bool IsRoundAboutVertical(const Body& body, const Pose& X_WB);

}  // namespace prehend::physics
