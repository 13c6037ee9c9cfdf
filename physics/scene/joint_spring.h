// SPDX-License-Identifier: Apache-2.0
// Spring and damping of a slider or a hinge: a force that both engines apply from outside, once a
// tick. No engine involved. Tested by tests/physics/scene/joint_spring_test.cc
#pragma once

#include <Eigen/Core>

#include "physics/scene/scene.h"

namespace prehend::physics {

/// One side of a joint, as far as a force has to move it. What is fixed has no inverses.
struct JointSide {
  double per_mass = 0;                                     ///< 1/kg
  Eigen::Matrix3d per_moment_W = Eigen::Matrix3d::Zero();  ///< 1/(kg m^2), about its centre
  Eigen::Vector3d centre_W_m = Eigen::Vector3d::Zero();    ///< of mass
  Eigen::Vector3d v_m_per_s = Eigen::Vector3d::Zero();     ///< of the centre
  Eigen::Vector3d w_rad_per_s = Eigen::Vector3d::Zero();
};

/// Where a joint stands now.
struct JointPlace {
  double position = 0;        ///< metres or radians
  Eigen::Vector3d axis_W;     ///< unit, the positive way
  Eigen::Vector3d pivot_W_m;  ///< a point of a hinge's axis; any point for a slider
};

/// The force (N) or torque (Nm) on the joint's body for the coming tick, along or about the axis;
/// its base has the opposite. Exact for a spring whose period is long against a tick: it then takes
/// no energy and gives none. Never stiffer than inertia / (n dt^2), nor damped by more than
/// inertia / (n dt), where n `sharers` pull at one body: what would explode within ticks is that
/// much weaker.
double SpringForce(const Joint& joint, const JointPlace& place, int sharers, const JointSide& base,
                   const JointSide& body, double dt_s);

/// How many joints with spring or damping, this one included, pull at its body or at its base, if
/// that moves: the larger of the two.
int SpringsOnOneBody(const Scene& scene, const Joint& joint);

}  // namespace prehend::physics
