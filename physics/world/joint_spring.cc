// SPDX-License-Identifier: Apache-2.0
// The effective inertia of the joint's free axis, by a Cholesky decomposition of order six.
#include "physics/world/joint_spring.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "physics/scene/joint.h"

namespace prehend::physics {
namespace {

using Eigen::Vector3d;
/// A rotation about the pivot and a translation of it; or a torque and a force there.
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

Eigen::Matrix3d Cross(const Vector3d& v) {
  return (Eigen::Matrix3d() << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0).finished();
}

/// Acceleration at the pivot in response to torque and force there.
Matrix6d ResponseAt(const Vector3d& pivot_W_m, const JointSide& side) {
  const Eigen::Matrix3d arm = Cross(pivot_W_m - side.centre_W_m);
  Matrix6d response;
  response.topLeftCorner<3, 3>() = side.per_moment_W;
  response.topRightCorner<3, 3>() = side.per_moment_W * arm;
  response.bottomLeftCorner<3, 3>() = -arm * side.per_moment_W;
  response.bottomRightCorner<3, 3>() =
      side.per_mass * Eigen::Matrix3d::Identity() - arm * side.per_moment_W * arm;
  return response;
}

Vector6d MotionAt(const Vector3d& pivot_W_m, const JointSide& side) {
  Vector6d motion;
  motion << side.w_rad_per_s, side.v_m_per_s + side.w_rad_per_s.cross(pivot_W_m - side.centre_W_m);
  return motion;
}

}  // namespace

double SpringForce(const Joint& joint, const JointPlace& place, int sharers, const JointSide& base,
                   const JointSide& body, double dt_s) {
  if (joint.spring == 0 && joint.damping == 0) return 0;
  if (base.per_mass == 0 && body.per_mass == 0) return 0;  // nothing to move
  const Vector3d pivot_W_m = joint.kind == JointKind::kSlider ? body.centre_W_m : place.pivot_W_m;
  Vector6d way = Vector6d::Zero();
  if (joint.kind == JointKind::kSlider)
    way.tail<3>() = place.axis_W;
  else
    way.head<3>() = place.axis_W;
  const double rate = way.dot(MotionAt(pivot_W_m, body) - MotionAt(pivot_W_m, base));
  // The joint prevents every motion but the one along `way`, with whatever forces that takes; only
  // the force along `way` does work.
  const Matrix6d response = ResponseAt(pivot_W_m, base) + ResponseAt(pivot_W_m, body);
  const double inertia = way.dot(response.ldlt().solve(way));
  const double share = inertia / sharers;
  const double spring = std::min(joint.spring, share / (dt_s * dt_s));
  const double damping = std::min(joint.damping, share / dt_s);
  return -spring * (place.position - joint.rest) - damping * rate;
}

int SpringsOnOneBody(const Scene& scene, const Joint& joint) {
  const auto springs_at = [&](BodyIndex rigid) {
    return static_cast<int>(std::ranges::count_if(scene.joints, [&](const Joint& other) {
      return (other.spring > 0 || other.damping > 0) &&
             (RootOf(scene, other.body) == rigid || RootOf(scene, other.base) == rigid);
    }));
  };
  const BodyIndex base = RootOf(scene, joint.base);
  const int at_base = scene.body(base).fixed ? 0 : springs_at(base);
  return std::max({1, at_base, springs_at(RootOf(scene, joint.body))});
}

}  // namespace prehend::physics
