// SPDX-License-Identifier: Apache-2.0
// Spring and damping of a slider or a hinge: a force that both engines apply from outside, once per
// tick. No engine involved. Tested by tests/physics/world/joint_spring_test.cc
#pragma once

#include <Eigen/Core>

#include "physics/scene/scene.h"

namespace prehend::physics {

/// One side of a joint: the mass properties that a force has to move. A fixed side has inverses of
/// zero.
struct JointSide {
  double per_mass = 0;                                     ///< 1/kg
  Eigen::Matrix3d per_moment_W = Eigen::Matrix3d::Zero();  ///< 1/(kg m^2), about its centre
  Eigen::Vector3d centre_W_m = Eigen::Vector3d::Zero();    ///< of mass
  Eigen::Vector3d v_m_per_s = Eigen::Vector3d::Zero();     ///< of the centre
  Eigen::Vector3d w_rad_per_s = Eigen::Vector3d::Zero();
};

/// Present position of a joint.
struct JointPlace {
  double position = 0;        ///< metres or radians
  Eigen::Vector3d axis_W;     ///< unit, positive direction
  Eigen::Vector3d pivot_W_m;  ///< a point of a hinge's axis; any point for a slider
};

/// The force (N) or torque (Nm) on the joint's body for the coming tick, along or about the axis;
/// the base gets the opposite. It is exact for a spring whose period is long compared with a tick,
/// which then neither gains nor loses energy. The stiffness is at most inertia / (n dt^2) and the
/// damping at most inertia / (n dt), where n = `sharers` springs pull at one body: stiffer ones
/// would be unstable.
double SpringForce(const Joint& joint, const JointPlace& place, int sharers, const JointSide& base,
                   const JointSide& body, double dt_s);

/// Number of joints with spring or damping, this one included, that pull at its body or at its base
/// (if the base moves): the larger of the two.
int SpringsOnOneBody(const Scene& scene, const Joint& joint);

}  // namespace prehend::physics
