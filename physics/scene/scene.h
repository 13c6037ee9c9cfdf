// SPDX-License-Identifier: Apache-2.0
// The world before the first tick: plain structs with defaults. SI units, world z up. A Scene is
// complete: the same Scene and script give the same run, bit for bit. Tested by
// tests/physics/scene/joint_test.cc
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "physics/base/pose.h"
#include "physics/scene/hand_model.h"
#include "physics/scene/hull.h"

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
using Shape = std::variant<Box, Sphere, Cylinder, Capsule, Hull>;

struct PlacedShape {
  Shape shape;
  Pose X_BS;
};

/// Loose small spheres, simulated one by one and reported as one body at their mean position.
struct Grains {
  double radius_m = 0.004;
  std::vector<Eigen::Vector3d> p_WG_m;  ///< their centres before the first tick; at least one
};

/// An abstract body has a pose and perhaps an extent, but no matter: it has no contacts, blocks no
/// line of sight and never moves.
enum class Abstract {
  kNot,
  kRegion,      ///< a box or a sphere
  kGazeTarget,  ///< a sphere that eyes can look at
  kCamera,      ///< looks along its x axis, up is along its z axis
  kLight
};

struct Body {
  std::string name;
  std::vector<PlacedShape> shapes;     ///< one, or several for a compound; none of grains
  std::optional<Grains> grains;        ///< many spheres that share the mass; only in Bullet
  Abstract abstract = Abstract::kNot;  ///< if not kNot: fixed, with one shape at the origin
  double view_deg = 33;                ///< of a camera: vertical field of view
  bool fixed = false;
  bool kinematic = false;  ///< moved by a Person: pushes, and is never pushed
  double mass_kg = 0;      ///< 0 only for fixed and kinematic bodies
  double friction = 0.8;
  double rolling_friction = 0;
  double restitution = 0;
  double linear_damping_per_s = 0;   ///< its speed decays at this rate, as in a viscous medium
  double angular_damping_per_s = 0;  ///< the same for its rotation
  Pose X_WB;
};

/// The motion that a joint leaves free. A ball joint has no limits, friction or spring.
enum class JointKind {
  kFixed,   ///< none: one rigid body, with contacts of either part
  kSlider,  ///< translation along the axis
  kHinge,   ///< rotation about the axis through the pivot
  kBall     ///< rotation about the pivot
};

/// Connects a body to another one, its base. At the initial poses the joint's position is 0. Units:
/// m, N, N s/m and N/m for a slider; rad, Nm, Nm s/rad and Nm/rad for a hinge.
struct Joint {
  JointKind kind = JointKind::kFixed;
  BodyIndex body = BodyIndex(0);                        ///< at most one joint per body
  BodyIndex base = BodyIndex(0);                        ///< bases form no circle
  Eigen::Vector3d pivot_W_m = Eigen::Vector3d::Zero();  ///< at the initial poses
  Eigen::Vector3d axis_W =
      Eigen::Vector3d::UnitX();  ///< unit, at the initial poses; positive direction
  double lower = 0;              ///< at most 0
  double upper = 0;              ///< at least 0
  double friction = 0;           ///< largest force or torque of static friction
  double damping = 0;            ///< force or torque per speed
  double spring = 0;             ///< force or torque per displacement from `rest`
  double rest = 0;               ///< position at which the spring is relaxed
};

/// What an imperfect tracker does to a hand's motion (class Tracker). The default is what a good
/// headset delivers: 90 samples per second, without errors.
struct TrackerSettings {
  int tracker_hz = 90;       ///< samples per second, at most the world's rate
  double latency_s = 0;      ///< from a sample to its arrival
  double jitter_mm = 0;      ///< standard deviation of each coordinate of a sample
  double jitter_deg = 0;     ///< standard deviation of each component of its rotation vector
  double dropped_share = 0;  ///< share of lost samples in the long run
  double dropped_run_s = 0;  ///< mean length of a loss; 0: losses are independent
  double tremor_mm = 0;      ///< amplitude along each axis; part of the hand's true motion
  double tremor_hz = 10;     ///< physiological tremor: 8-12 Hz (Elble & Koller 1990)
};

/// A hand of the scene: its model, and the pose at which it and its tracked target start.
struct Hand {
  std::string name;
  HandModel model;
  Pose X_WH;
  std::optional<TrackerSettings> tracking =
      std::nullopt;  ///< none: a perfect tracker without delay
};

/// Where a person looks if no step of the script says so.
enum class Eyes {
  kLead,  ///< where her hands go next (Johansson et al. 2001)
  kAhead  ///< straight ahead
};

/// A human: a head that looks around, and perhaps a body. Her parts are consecutive kinematic
/// bodies of the scene, from `head` on, in the order of physics/person/skeleton.h.
struct Person {
  std::string name;
  BodyIndex head = BodyIndex(0);
  bool has_body = false;   ///< else there is only a head
  double height_m = 1.75;  ///< standing, from the floor to the crown
  Pose X_WS;               ///< her stance: between her feet on the floor, x ahead, z up
  Eyes eyes = Eyes::kLead;
  HandIndex right_hand = {};  ///< that her arm follows; or none
  HandIndex left_hand = {};
};

enum class Engine {
  kBullet,
  kBox2d,
  kBulletStock  ///< Bullet without our replacements of its parts, to compare with them
};

struct WorldSettings {
  Engine engine = Engine::kBullet;
  /// All bodies and hands lie in the plane y = 0 (physics/scene/planar.h), stay in it and rotate
  /// about y only. Box2D requires it.
  bool planar = false;
  int rate_hz = 480;
  std::uint64_t seed = 1;
  double gravity_m_per_s2 = 9.81;
};

struct Scene {
  WorldSettings world;
  std::vector<Body> bodies;
  std::vector<Joint> joints;
  std::vector<Hand> hands;
  std::vector<Person> persons;

  const Body& body(BodyIndex index) const { return At(bodies, index); }
  const Hand& hand(HandIndex index) const { return At(hands, index); }
};

/// Whether a body is a thing: it can carry others and be grasped. Parts of persons, grains and
/// abstract bodies are not.
bool IsThing(const Body& body);

/// Whether a body can be picked up: it is a thing, not fixed, and no joint ties it to another body.
bool MovesFreely(const Scene& scene, BodyIndex body);

/// Tight oriented bounding box of a body, in its own frame B: centre and half sizes, metres.
struct LocalBox {
  Eigen::Vector3d p_BC_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d half_size_m = Eigen::Vector3d::Zero();
};
LocalBox BoundingBox(const Body& body);

}  // namespace prehend::physics
