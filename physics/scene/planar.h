// SPDX-License-Identifier: Apache-2.0
// The plane y = 0 of planar scenes: which shapes lie in it, and their cross-sections. A body lies
// in the plane if each of its shapes is symmetric to the plane and has the same cross-section all
// along y; then two cross-sections touch exactly where the solids touch, and a planar engine misses
// no contact. No engine involved. Tested by tests/physics/scene/planar_test.cc
#pragma once

#include <string>

#include "physics/scene/scene.h"

namespace prehend::physics {

/// Whether the centre and two axes are in the plane: the y axis is the world's or its opposite.
bool KeepsPlane(const Pose& X_WB);

/// Whether the shape lies in the plane: a box with two edges in it, a cylinder or capsule with its
/// axis in it or across it, or a sphere; each with its centre in the plane.
bool LiesInPlane(const Shape& shape, const Pose& X_WS);

/// Empty if the whole body lies in the plane, otherwise the reason why not.
std::string WhyNotPlanar(const Body& body);

/// Empty if the joint moves its body in the plane only, otherwise the reason why not.
std::string WhyNotPlanar(const Joint& joint);

/// Empty if palm, links, joints and grasps lie in the hand's own plane y = 0, otherwise the reason
/// why not.
std::string WhyNotPlanar(const HandModel& model);

/// A cross-section: a rectangle, rounded by a radius. A disc has size 0 and a radius.
struct Outline {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();  ///< x and z in the frame asked for
  double angle_rad = 0;                                ///< from x towards z
  Eigen::Vector2d half_size_m = Eigen::Vector2d::Zero();
  double radius_m = 0;
};

/// The cross-section of a shape in the plane, in the frame F; KeepsPlane(F) holds.
Outline OutlineOf(const Shape& shape, const Pose& X_FS);

/// Moment of inertia of a shape in the plane about the axis along y through its centre, kg m^2.
double MomentAboutY(const Shape& shape, const Pose& X_FS, double mass_kg);

}  // namespace prehend::physics
