// SPDX-License-Identifier: Apache-2.0
// The rows between rigid bodies of btSequentialImpulseConstraintSolver, made faster. Same rows,
// same arithmetic, except that friction and rolling friction are limited by circles
// (physics/bullet/core/friction_circle.h). Every row is first written out flat, a side that does
// not move costs nothing, and rows without a common body are adjacent, so that none waits for its
// neighbour's result. Tested by tests/physics/bullet/solver_test.cc
#pragma once

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/ConstraintSolver/btSolverBody.h>

#include <vector>

#include "physics/bullet/core/friction_circle.h"
#include "physics/bullet/core/multibody_inertia.h"

namespace prehend::physics {

/// Linear parts, then angular parts.
inline Six SixOf(const btVector3& linear, const btVector3& angular) {
  return {linear.x(), linear.y(), linear.z(), angular.x(), angular.y(), angular.z()};
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
    if (!speeds) return;
    btScalar* const __restrict v = speeds->data();
    const btScalar* const __restrict r = response.data();
    for (std::size_t i = 0; i < 6; ++i) v[i] += r[i] * impulse;
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

/// Requires rows in a fixed order, friction rows after all contact rows (Bullet's defaults), and
/// two friction directions.
class RigidRows {
 public:
  /// Bullet's rows of one group of islands; they must outlive the other calls.
  struct Pools {
    btAlignedObjectArray<btSolverBody>& bodies;
    btConstraintArray &joints, &contacts, &frictions, &rolling;
  };
  void Setup(const Pools& pools);

  /// The solver's change of the speeds of a body, by its index in Pools::bodies.
  Six& SpeedsOf(int body) { return speeds_[static_cast<std::size_t>(body)]; }

  /// The same of what only corrects penetration.
  Six& PushesOf(int body) { return pushes_[static_cast<std::size_t>(body)]; }

  /// Solves each row once. Rows that are not joints take part in the first `contact_iterations`
  /// iterations, rows of grains in every kGrainPeriod-th. Returns the largest squared change of a
  /// speed.
  btScalar Solve(int iteration, int contact_iterations);
  /// The same for rows that only correct penetration ("split impulse").
  btScalar SolvePenetrations();

  /// Writes impulses and speeds back to Bullet's rows and bodies.
  void WriteBack(const Pools& pools) const;

 private:
  struct Row {
    RigidSide side;  ///< a side that moves, if there is one
    int other = -1;  ///< index into others_, if both sides move
    btScalar wanted, softness, inverse_mass, mass, least, most, friction;
    btScalar impulse;
    const btScalar* pressure;  ///< of a friction row: impulse of its contact
    int iterations;            ///< of a joint: number of iterations
    bool grain;                ///< one of the bodies is a grain
    const btSolverConstraint* source;
  };
  using Rows = std::vector<Row>;

  /// Computes the order of groups of `group` rows, which have the same bodies. Groups with a common
  /// body keep their order, and so do the rows of a group.
  void Arrange(const btConstraintArray& sources, std::size_t group,
               const btAlignedObjectArray<btSolverBody>& bodies);
  void Flatten(const Pools& pools, const btConstraintArray& sources, std::size_t group, Rows& rows);
  Row MakeRow(const btSolverConstraint& source, const Pools& pools, std::vector<Six>& speeds);
  void TakePenetrations(const Pools& pools);
  const RigidSide* OtherOf(const Row& row) const;
  /// Change of the impulse that gives the wanted speed, without limits.
  btScalar WantedChange(const Row& row) const;
  void Push(Row& row, btScalar change);
  btScalar Solve(Row& row);
  btScalar Coupling(const Row& first, const Row& second) const;
  /// Two rows of friction of one contact, whose impulses together are at most `limit`.
  btScalar SolvePair(Row& first, Row& second, btScalar limit, const PrincipalResponse& response);

  std::vector<Six> speeds_, pushes_;  ///< by body
  using Responses = std::vector<PrincipalResponse>;
  /// Of the last two of every `group` rows.
  void ComputeResponses(const Rows& rows, std::size_t group, Responses& responses) const;

  Rows joints_, contacts_, frictions_, rolling_, penetrations_;
  Responses friction_responses_, rolling_responses_;  ///< by pair of rows
  btScalar grains_change_ = 0;  ///< largest squared change of a speed, when they were last solved
  std::vector<RigidSide> others_;
  std::vector<const btScalar*> pressures_;               ///< by index in the pool of contacts
  std::vector<int> order_, level_, next_, bodys_level_;  ///< of Arrange()
};

}  // namespace prehend::physics
