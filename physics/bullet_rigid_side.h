// SPDX-License-Identifier: Apache-2.0
// A rigid body as a row of the solver sees it. Tested by tests/physics/bullet_solver_test.cc
#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>

#include <array>

namespace prehend::physics {

/// Linear parts, then angular parts.
using Six = std::array<btScalar, 6>;

inline Six SixOf(const btVector3& linear, const btVector3& angular) {
  return {linear.x(), linear.y(), linear.z(), angular.x(), angular.y(), angular.z()};
}

/// What a row reads and changes of one of its bodies. Sums stand in Bullet's order, to the last
/// bit.
struct RigidSide {
  Six* speeds = nullptr;  ///< what the solver adds to the body's; null: the body does not move
  Six jacobian{};
  Six response{};  ///< to a unit impulse

  btScalar SpeedAlong() const {
    if (!speeds) return 0;
    const Six &j = jacobian, &v = *speeds;
    return (j[0] * v[0] + j[1] * v[1] + j[2] * v[2]) + (j[3] * v[3] + j[4] * v[4] + j[5] * v[5]);
  }

  void Push(btScalar impulse) const {
    if (!speeds) return;
    for (std::size_t i = 0; i < 6; ++i) (*speeds)[i] += response[i] * impulse;
  }
};

inline bool Moves(const btSolverBody& body) {
  return body.m_originalBody && !body.internalGetInvMass().isZero();
}

/// `speeds` are those of the body.
inline RigidSide MakeRigidSide(const btSolverBody& body, Six& speeds, const btVector3& linear,
                               const btVector3& angular, const btVector3& angular_response) {
  if (!Moves(body)) return {};
  return {.speeds = &speeds,
          .jacobian = SixOf(linear, angular),
          .response = SixOf(linear * body.internalGetInvMass() * body.m_linearFactor,
                            angular_response * body.m_angularFactor)};
}

}  // namespace prehend::physics
