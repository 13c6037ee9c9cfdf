// SPDX-License-Identifier: Apache-2.0
// What a row of the solver reads and changes of one rigid body. Only for physics/bullet/core.
// Tested by tests/physics/bullet/solver_test.cc
#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>

#include <array>
#include <cstring>

#include "physics/bullet/core/multibody_inertia.h"

namespace prehend::physics {

/// Linear parts, then angular parts.
inline Six SixOf(const btVector3& linear, const btVector3& angular) {
  return {linear.x(), linear.y(), linear.z(), angular.x(), angular.y(), angular.z()};
}

/// Adds `factor` times `change`, which is other memory, to `sum`: two elements at once, which no
/// compiler does by itself.
[[gnu::always_inline]] inline void AddTimes(Six& sum, const Six& change, btScalar factor) {
  using Two = btScalar __attribute__((vector_size(2 * sizeof(btScalar))));
  std::array<Two, 3> s, c;
  std::memcpy(s.data(), sum.data(), sizeof s);
  std::memcpy(c.data(), change.data(), sizeof c);
  s = {s[0] + c[0] * factor, s[1] + c[1] * factor, s[2] + c[2] * factor};
  std::memcpy(sum.data(), s.data(), sizeof s);
}

/// One rigid body of a row: what the row reads and changes of it. Sums are in Bullet's order, to
/// the last bit.
struct RigidSide {
  Six* speeds = nullptr;  ///< solver's change of the body's speeds; null: fixed
  Six jacobian{};
  Six response{};  ///< change of the speeds by a unit impulse

  btScalar SpeedAlong() const {
    if (!speeds) return 0;
    const Six &j = jacobian, &v = *speeds;
    return (j[0] * v[0] + j[1] * v[1] + j[2] * v[2]) + (j[3] * v[3] + j[4] * v[4] + j[5] * v[5]);
  }

  /// Change of this side's speed along its row by a unit impulse of `other`, a side on the same
  /// body.
  btScalar SpeedBy(const RigidSide& other) const {
    if (!speeds) return 0;
    const Six &j = jacobian, &v = other.response;
    return (j[0] * v[0] + j[1] * v[1] + j[2] * v[2]) + (j[3] * v[3] + j[4] * v[4] + j[5] * v[5]);
  }

  void Push(btScalar impulse) const {
    if (speeds) AddTimes(*speeds, response, impulse);
  }
};

inline bool Moves(const btSolverBody& body) {
  return body.m_originalBody && !body.internalGetInvMass().isZero();
}

/// `speeds`: the solver's change of the body's speeds.
inline RigidSide MakeRigidSide(const btSolverBody& body, Six& speeds, const btVector3& linear,
                               const btVector3& angular, const btVector3& angular_response) {
  if (!Moves(body)) return {};
  return {.speeds = &speeds,
          .jacobian = SixOf(linear, angular),
          .response = SixOf(linear * body.internalGetInvMass() * body.m_linearFactor,
                            angular_response * body.m_angularFactor)};
}

}  // namespace prehend::physics
