// SPDX-License-Identifier: Apache-2.0
// What stands in the world before the first tick: plain structs with defaults. SI units, world z
// up. A Scene is complete: the same Scene and script give the same run, bit for bit. Tested by
// tests/physics/scene_test.cc
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "physics/hand_model.h"
#include "physics/pose.h"

namespace prehend::physics {

struct Box {
  Eigen::Vector3d size_m = {0.1, 0.1, 0.1};  ///< full edge lengths
};
struct Sphere {
  double radius_m = 0.05;
};
struct Cylinder {  ///< axis along z
  double radius_m = 0.05;
  double length_m = 0.1;
};
struct Capsule {  ///< axis along z; length without the caps
  double radius_m = 0.05;
  double length_m = 0.1;
};
using Shape = std::variant<Box, Sphere, Cylinder, Capsule>;

struct PlacedShape {
  Shape shape;
  Pose X_BS;
};

struct Body {
  std::string name;
  std::vector<PlacedShape> shapes;  ///< one, or several for a compound
  bool fixed = false;
  double mass_kg = 0;  ///< 0 only for fixed bodies
  double friction = 0.8;
  double rolling_friction = 0;
  double restitution = 0;
  Pose X_WB;
};

/// A hand that takes part: the model says how it is built, the pose where the tracked target
/// starts.
struct Hand {
  std::string name;
  HandModel model;
  Pose X_WH;
};

struct WorldSettings {
  int rate_hz = 480;
  std::uint64_t seed = 1;
  double gravity_m_per_s2 = 9.81;
};

struct Scene {
  WorldSettings world;
  std::vector<Body> bodies;
  std::vector<Hand> hands;
};

/// Tight oriented bounding box of a body, in its own frame B: centre and half sizes, metres.
struct LocalBox {
  Eigen::Vector3d p_BC_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d half_size_m = Eigen::Vector3d::Zero();
};
LocalBox BoundingBox(const Body& body);

}  // namespace prehend::physics
