// SPDX-License-Identifier: Apache-2.0
// How a hand is built and how it grasps, as data: read from physics/library/*.hand.yaml by the harness.
// Hand frame H: origin at the palm's centre, x along the fingers, y towards the thumb of a right hand, z out of the
// back of the hand. A left hand is the mirror image in the xz-plane.
#pragma once

#include <string>
#include <vector>

#include "physics/pose.h"

namespace prehend::physics {

struct HandLink {
  std::string name;
  int parent = -1;  ///< index into HandModel::links; -1 is the palm
  Eigen::Vector3d pivot_m = Eigen::Vector3d::Zero();       ///< joint, in H, all joints at zero
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();    ///< from the pivot along the link, unit, in H
  Eigen::Vector3d joint_axis = Eigen::Vector3d::UnitY();   ///< unit, in H; positive angles close
  double length_m = 0.03;
  double half_width_m = 0.008;
  double half_thickness_m = 0.007;
  double mass_kg = 0.01;
  double strength_nm = 1.0;  ///< torque limit of the joint driver at effort 1
  double lower_rad = -0.2;
  double upper_rad = 1.6;
  int sensor_set = 0;  ///< index into HandModel::sensor_sets
};

/// Force- or torque-limited PID that makes the palm follow the tracked target.
struct PidGains {
  double proportional = 0;
  double derivative = 0;
  double integral = 0;
  double limit = 0;           ///< clamp of the output, N or Nm
  double integral_share = 0.6;  ///< the integral's part is at most this share of the limit
};

/// Torque-limited velocity servo of a joint.
struct JointDriver {
  double stiffness = 0.2;            ///< share of the angle error removed per tick
  double damping = 1.0;              ///< 0..1, how firmly the target velocity is enforced
  double max_speed_rad_per_s = 12;
};

/// One style: frames of joint targets from open to closed, interpolated by the trigger, and the effort of each joint.
struct GraspStyle {
  std::string name;
  std::vector<std::vector<double>> frames_rad;  ///< at least 2; one angle per link
  std::vector<double> effort;                   ///< one per link, share of strength_nm
  Eigen::Vector3d grasp_point_m = Eigen::Vector3d::Zero();  ///< in H: where the object's grasp point shall be
};

struct HandModel {
  std::string name;
  bool left = false;
  Eigen::Vector3d palm_size_m = {0.090, 0.084, 0.025};
  double palm_mass_kg = 0.6;
  double palm_inertia_scale = 6;  ///< stands for the forearm; without it the palm twists (docs/physics.md)
  double friction = 1.0;
  double spinning_friction = 0.01;
  Eigen::Vector3d ahead = Eigen::Vector3d::UnitX();  ///< unit, in H: where the hand reaches to
  std::vector<std::string> sensor_sets;              ///< e.g. fingers, thumb, palm
  int palm_sensor_set = 0;
  std::vector<HandLink> links;
  PidGains translation, rotation;
  JointDriver driver;
  std::vector<GraspStyle> styles;
};

}  // namespace prehend::physics
