// SPDX-License-Identifier: Apache-2.0
// A world that is simulated as its mirror image. No engine treats left and right alike to the last
// bit: the order in which corners are found and contacts are solved favours a side, and a release
// some frames later is another timeline. So a scene of a left hand is simulated as that of the
// right hand which it mirrors, and both do exactly the same. Mirrors lie in the plane y = 0. The
// image of a body is built in its mirrored frame, so its pose is a rotation again. Nothing is
// rounded: the image of an image is the original, bit for bit. Tested by
// tests/physics/world/mirrored_world_test.cc
#pragma once

#include <memory>

#include "physics/motion/script.h"
#include "physics/world/world.h"

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

/// Whether a left hand leads: there is no right one, or it has more to do in the first stage of the
/// script in which one of the sides has more to do.
bool LeftHandLeads(const Scene& scene, const Script& script);

/// The mirror image of `image`, which is a world of InMirror(scene).
std::unique_ptr<World> MirrorImageOf(std::unique_ptr<World> image);

}  // namespace prehend::physics
