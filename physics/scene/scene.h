// SPDX-License-Identifier: Apache-2.0
// What stands in the world before the first tick: plain structs with defaults. SI units, world z
// up. A Scene is complete: the same Scene and script give the same run, bit for bit. Tested by
// tests/physics/scene/joint_test.cc
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "physics/scene/hand_model.h"
#include "physics/scene/hull.h"
#include "physics/scene/pose.h"

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

/// Loose small balls, simulated one by one and seen as one body, whose place is the mean of theirs.
struct Grains {
  double radius_m = 0.004;
  std::vector<Eigen::Vector3d> p_WG_m;  ///< their centres before the first tick; at least one
};

/// What has a place, and perhaps room, but no matter: nothing touches it, no ray of sight meets it,
/// it never moves.
enum class Abstract {
  kNot,
  kRegion,      ///< a box or a ball
  kGazeTarget,  ///< a ball that eyes can look at
  kCamera,      ///< looks along its x axis, up is along its z axis
  kLight
};

struct Body {
  std::string name;
  std::vector<PlacedShape> shapes;  ///< one, or several for a compound; none of grains
  std::optional<Grains>
      grains;  ///< it is not one thing but many, which share its mass; only in Bullet
  Abstract abstract = Abstract::kNot;  ///< then it is also fixed, and has one shape, at its origin
  double view_deg = 33;                ///< of a camera: how much it sees from below to above
  bool fixed = false;
  bool kinematic = false;  ///< moves as a Person's motion says: pushes, and is never pushed
  double mass_kg = 0;      ///< 0 only for fixed and kinematic bodies
  double friction = 0.8;
  double rolling_friction = 0;
  double restitution = 0;
  double linear_damping_per_s = 0;   ///< its speed decays with this rate, as if in a thick medium
  double angular_damping_per_s = 0;  ///< the same for its turning
  Pose X_WB;
};

/// What a joint leaves free. A ball joint has no limits, friction or spring.
enum class JointKind {
  kFixed,   ///< nothing: the two are one rigid body, but touched apart
  kSlider,  ///< motion along the axis
  kHinge,   ///< turning about the axis through the pivot
  kBall     ///< turning about the pivot
};

/// Ties a body to another one, its base. As placed, the joint stands at 0. Metres, newtons and
/// newton seconds per metre for a slider; radians and newton metres for a hinge.
struct Joint {
  JointKind kind = JointKind::kFixed;
  int body = 0;  ///< index into Scene::bodies; at most one joint per body
  int base = 0;  ///< index into Scene::bodies; no body is its own base's base
  Eigen::Vector3d pivot_W_m = Eigen::Vector3d::Zero();  ///< as placed
  Eigen::Vector3d axis_W = Eigen::Vector3d::UnitX();    ///< unit, as placed; positive way
  double lower = 0;                                     ///< at most 0
  double upper = 0;                                     ///< at least 0
  double friction = 0;  ///< largest force or torque that holds still
  double damping = 0;   ///< force or torque per speed
  double spring = 0;    ///< force or torque per distance from `rest`
  double rest = 0;      ///< where the spring pulls to
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

/// A hand that takes part: the model says how it is built, the pose where the tracked target
/// starts.
struct Hand {
  std::string name;
  HandModel model;
  Pose X_WH;
  std::optional<TrackerSettings> tracking =
      std::nullopt;  ///< none: the tracked target is where the script wants it
};

/// Where a person looks when nobody tells her to.
enum class Eyes {
  kLead,  ///< where her hands go next (Johansson et al. 2001)
  kAhead  ///< straight ahead
};

/// A human: a head that looks about, and perhaps a body. Her parts are kinematic bodies of the
/// scene, one after another from `head` on; their order is in physics/person/skeleton.h.
struct Person {
  std::string name;
  int head = 0;            ///< index into Scene::bodies
  bool has_body = false;   ///< else she is only a head
  double height_m = 1.75;  ///< standing, from the floor to the crown
  Pose X_WS;               ///< where she stands: between her feet on the floor, x ahead, z up
  Eyes eyes = Eyes::kLead;
  int right_hand = -1;  ///< index into Scene::hands: the hand that her arm follows; -1: none
  int left_hand = -1;
};

enum class Engine { kBullet, kBox2d };

struct WorldSettings {
  Engine engine = Engine::kBullet;
  /// Everything stays in the plane y = 0 and turns about y alone; all that takes part lies in it
  /// (physics/scene/planar.h). Box2D needs it.
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
};

/// A thing can carry others and be grasped; parts of persons, grains and what is abstract cannot.
bool IsThing(const Body& body);

/// Can it be picked up? Not when it is fixed or no thing, nor when a joint ties it to something.
bool MovesFreely(const Scene& scene, int body);

/// Tight oriented bounding box of a body, in its own frame B: centre and half sizes, metres.
struct LocalBox {
  Eigen::Vector3d p_BC_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d half_size_m = Eigen::Vector3d::Zero();
};
LocalBox BoundingBox(const Body& body);

}  // namespace prehend::physics
