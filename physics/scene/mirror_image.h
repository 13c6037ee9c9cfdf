// SPDX-License-Identifier: Apache-2.0
// Mirror images in the plane y = 0. The image of a body is built in its mirrored frame, so its pose
// is a rotation again. Nothing is rounded: the image of an image is the original, bit for bit.
// Tested by tests/physics/world/mirrored_world_test.cc
#pragma once

#include "physics/scene/scene.h"

namespace prehend::physics {

/// Of points and directions. 0 stays +0.
inline Eigen::Vector3d InMirror(const Eigen::Vector3d& v) { return {v.x(), 0.0 - v.y(), v.z()}; }
/// Of rotation vectors, angular velocities and axes of rotation.
inline Eigen::Vector3d AxisInMirror(const Eigen::Vector3d& v) {
  return {0.0 - v.x(), v.y(), 0.0 - v.z()};
}
inline Eigen::Quaterniond InMirror(const Eigen::Quaterniond& q) {
  return {q.w(), 0.0 - q.x(), q.y(), 0.0 - q.z()};
}
inline Pose InMirror(const Pose& X) { return {InMirror(X.p_m), InMirror(X.q)}; }

/// In the body's own frame.
PlacedShape InMirror(PlacedShape placed);
Body InMirror(Body body);
Joint InMirror(Joint joint);
/// A right hand becomes a left one.
Hand InMirror(Hand hand);
/// All of it but persons, whose right hand stays a right one.
Scene InMirror(Scene scene);

}  // namespace prehend::physics
