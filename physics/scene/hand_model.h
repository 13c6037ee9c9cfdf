// SPDX-License-Identifier: Apache-2.0
// How a hand is built and how it grasps, as data; the harness reads it from
// physics/library/*.hand.yaml. Hand frame H: origin at the palm's centre, x along the fingers, y
// towards the thumb of a right hand, z out of the back of the hand. A left hand is the mirror image
// in the xz-plane: see Mirrored(). Tested by tests/physics/scene/hand_model_test.cc
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "physics/base/ids.h"
#include "physics/base/pose.h"

namespace prehend::physics {

struct HandLink {
  std::string name;
  LinkIndex parent = {};                              ///< none is the palm
  Eigen::Vector3d pivot_m = Eigen::Vector3d::Zero();  ///< of the joint, in H, all joints at zero
  Eigen::Vector3d direction =
      Eigen::Vector3d::UnitX();  ///< from the pivot along the link, unit, in H
  bool slides = false;           ///< along the joint axis; else it rotates about it
  Eigen::Vector3d joint_axis = Eigen::Vector3d::UnitY();  ///< unit, in H; positive values close
  double length_m = 0.03;
  double half_width_m = 0.008;
  double half_thickness_m = 0.007;
  double mass_kg = 0.01;
  double strength = 1.0;  ///< limit of the joint driver at effort 1: newton metres, or newtons
  double lower = -0.2;    ///< radians, or metres of a link that slides
  double upper = 1.6;     ///< the same
  int sensor_set = 0;     ///< index into HandModel::sensor_sets
};

/// A PID with limited force or torque; it makes the palm follow the tracked target.
struct PidGains {
  double proportional = 0;
  double derivative = 0;
  double integral = 0;
  double limit = 0;             ///< clamp of the output, N or Nm
  double integral_share = 0.6;  ///< largest share of the limit that the integral term may take
};

/// Velocity servo of a joint, with limited torque.
struct JointDriver {
  /// Shares are of a tick at this rate. In shorter ticks both are smaller, so that a joint follows
  /// alike, and yields alike to a load: by what the solver leaves over, which goes with the square.
  static constexpr double kStiffnessRate_hz = 480;
  double stiffness = 0.2;  ///< share of the angle's error that is removed
  double damping = 1.0;    ///< 0..1: the same of the speed's
  double max_speed_rad_per_s = 12;
  double max_slide_m_per_s = 0.3;  ///< the same for links that slide
};

/// How the hand approaches an object, from above or from the side. The object's centre ends on a
/// line along `toward`.
struct GraspApproach {
  Eigen::Vector3d toward = -Eigen::Vector3d::UnitZ();  ///< unit, in H: direction of arrival
  Eigen::Vector3d up =
      Eigen::Vector3d::UnitY();  ///< unit, in H: up in the world; only from the side
  double palm_gap_m = 0.02;      ///< least distance of H's origin from the object's nearest face
  double pads_m = 0.07;  ///< wanted distance of the object's centre from H's origin, along `toward`
  double floor_m = 0.05;  ///< least height of H's origin over the surface below the object
};

/// A grasp style: frames of joint targets from open to closed, interpolated by the trigger, and the
/// effort of each joint. One side of the hand is a stiff post, the other side is force-limited; the
/// object's face is placed at the post.
struct GraspStyle {
  std::string name;
  std::vector<std::vector<double>> frames;  ///< at least 2; one joint target per link
  std::vector<double> effort;               ///< one per link: share of HandLink::strength
  Eigen::Vector3d grip_axis =
      Eigen::Vector3d::UnitX();  ///< unit, in H: from the post to the limited side
  Eigen::Vector3d post_m =
      Eigen::Vector3d::Zero();               ///< in H: where the object's face meets the post
  double opening_m = 0.085;                  ///< widest object that fits, along the grip axis
  std::optional<GraspApproach> above, side;  ///< at least one
};

struct HandModel {
  std::string name;
  bool left = false;
  Eigen::Vector3d palm_size_m = {0.090, 0.084, 0.025};
  double palm_mass_kg = 0.6;
  double palm_inertia_scale =
      6;  ///< represents the forearm; without it the palm twists (docs/physics.md)
  double friction = 1.0;
  double spinning_friction = 0.01;
  Eigen::Vector3d ahead = Eigen::Vector3d::UnitX();  ///< unit, in H: the direction of reaching
  std::vector<std::string> sensor_sets;              ///< e.g. fingers, thumb, palm
  int palm_sensor_set = 0;
  std::vector<HandLink> links;
  PidGains translation, rotation;
  JointDriver driver;
  std::vector<GraspStyle> styles;

  const HandLink& link(LinkIndex index) const { return At(links, index); }
};

/// Target speed of the joint driver, rad/s or m/s: towards `target`, within the driver's limit.
double WantedSpeed(const JointDriver& driver, const HandLink& link, double target, double joint,
                   double dt_s);

/// Joint targets of a style at a trigger value from 0 (open) to 1 (closed), linear between
/// neighbouring frames; one per link.
std::vector<double> JointTargets(const GraspStyle& style, double trigger);

/// Centre frames of all links in H, x along the link, for the given joints (radians or metres, one
/// per link).
std::vector<Pose> LinkPoses(const HandModel& model, const std::vector<double>& joints);

/// The mirror image in the xz-plane, with `left` toggled.
HandModel Mirrored(HandModel model);

/// Index of the style with this name, or -1.
int FindStyle(const HandModel& model, const std::string& name);

/// Empty if the palm's PIDs can follow a target and are stable at this rate, for the mass and the
/// moments of inertia of the whole hand; otherwise the reason.
std::string CheckGains(const HandModel& model, int rate_hz);

// Where the links of a hand are that has these joints: forward kinematics, link after link. All
// arithmetic is written out, sines and cosines too, so that every processor and every library gives
// the same bits. Episode files do not keep what follows from it (docs/episodes.md): another last
// bit here is another content of the files that people have. Tested by
// tests/physics/scene/link_places_test.cc

class LinkPlaces {
 public:
  explicit LinkPlaces(const HandModel& model);

  /// The poses of all links in the world, in the order of the model, from the palm's pose and the
  /// positions of the joints.
  void Place(const Pose& X_WPalm, const std::vector<double>& joints, std::vector<Pose>& X_WL) const;

 private:
  struct Link {
    LinkIndex parent = {};
    bool slides = false;
    Eigen::Quaterniond q_PL;  ///< from the link's frame to its parent's, the joint at zero
    Eigen::Vector3d axis;     ///< of the joint, in the link's frame
    Eigen::Vector3d p_PJ_m;   ///< the joint in the parent's frame
    Eigen::Vector3d p_JL_m;   ///< from the joint to the link's centre, in the link's frame
  };
  std::vector<Link> links_;
};

}  // namespace prehend::physics
