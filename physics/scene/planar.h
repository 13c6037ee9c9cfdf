// SPDX-License-Identifier: Apache-2.0
// The plane y = 0 of planar scenes: what lies in it, and the section that it cuts. A thing lies in
// the plane when each of its shapes is symmetric to it and keeps one cross-section all along y; so
// its section meets another one where the solids themselves do, and a planar engine misses nothing.
// No engine involved. Tested by tests/physics/scene/planar_test.cc
#pragma once

#include <string>

#include "physics/scene/scene.h"

namespace prehend::physics {

/// Centre and two axes in the plane: its y axis is the world's, or the opposite.
bool KeepsPlane(const Pose& X_WB);

/// A box with two edges, or a cylinder or capsule with its axis, in the plane or across it; any
/// sphere; each with its centre in the plane.
bool LiesInPlane(const Shape& shape, const Pose& X_WS);

/// Empty when the whole body lies in the plane, otherwise why not.
std::string WhyNotPlanar(const Body& body);

/// Empty when the joint moves its body in the plane only, otherwise why not.
std::string WhyNotPlanar(const Joint& joint);

/// Empty when palm, links, joints and grasps lie in the hand's own plane y = 0, otherwise why not.
std::string WhyNotPlanar(const HandModel& model);

/// A section: a rectangle, rounded by a radius. A disc has no size, only a radius.
struct Outline {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();  ///< x and z in the frame asked for
  double angle_rad = 0;                                ///< from x towards z
  Eigen::Vector2d half_size_m = Eigen::Vector2d::Zero();
  double radius_m = 0;
};

/// The section of a shape that lies in the plane, in the frame F that it stands in; F keeps the
/// plane.
Outline OutlineOf(const Shape& shape, const Pose& X_FS);

/// About an axis along y through its own centre, of a shape that lies in the plane: kg m^2.
double MomentAboutY(const Shape& shape, const Pose& X_FS, double mass_kg);

}  // namespace prehend::physics
