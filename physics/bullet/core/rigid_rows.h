// SPDX-License-Identifier: Apache-2.0
// The rows of btSequentialImpulseConstraintSolver (between rigid bodies), made faster. Same rows,
// same arithmetic, hence the same bits; but each is first written out flat, a side that does not
// move costs nothing, and rows that share no body stand beside each other, so that none waits for
// its neighbour's result. Tested by tests/physics/bullet/solver_test.cc
#pragma once

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/ConstraintSolver/btSolverBody.h>

#include <array>
#include <vector>

namespace prehend::physics {

/// Linear parts, then angular parts.
using Six = std::array<btScalar, 6>;

inline Six SixOf(const btVector3& linear, const btVector3& angular) {
  return {linear.x(), linear.y(), linear.z(), angular.x(), angular.y(), angular.z()};
}

/// A rigid body as a row of the solver sees it: what the row reads and changes of it. Sums stand in
/// Bullet's order, to the last bit.
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

/// Asks for an order of rows that is not random, and frictions after all contacts (Bullet's
/// defaults).
class RigidRows {
 public:
  /// What Bullet has set up of one group of islands; must outlive the rest.
  struct Pools {
    btAlignedObjectArray<btSolverBody>& bodies;
    btConstraintArray &joints, &contacts, &frictions, &rolling;
  };
  void Setup(const Pools& pools);

  /// What the solver adds to the speeds of this body, by its index in Pools::bodies.
  Six& SpeedsOf(int body) { return speeds_[static_cast<std::size_t>(body)]; }

  /// Each row once; `contact_iterations` is for how many iterations all but joints take part.
  /// Returns the largest squared change of a speed.
  btScalar Solve(int iteration, int contact_iterations);
  /// Likewise for what only moves bodies out of each other ("split impulse").
  btScalar SolvePenetrations();

  /// Impulses and speeds go to where Bullet looks for them.
  void WriteBack(const Pools& pools) const;

 private:
  struct Row {
    RigidSide side;  ///< one that moves, if one does
    int other = -1;  ///< index into others_, if both do
    btScalar wanted, softness, inverse_mass, mass, least, most, friction;
    btScalar impulse;
    const btScalar* pressure;  ///< of a friction row: its contact's impulse
    int iterations;            ///< of a joint: takes part in so many
    const btSolverConstraint* source;
  };
  using Rows = std::vector<Row>;

  /// In which order to go through them; those that share a body keep theirs.
  void Arrange(const btConstraintArray& sources, const btAlignedObjectArray<btSolverBody>& bodies);
  void Flatten(const Pools& pools, const btConstraintArray& sources, Rows& rows);
  Row MakeRow(const btSolverConstraint& source, const Pools& pools, std::vector<Six>& speeds);
  void TakePenetrations(const Pools& pools);
  btScalar Solve(Row& row);

  std::vector<Six> speeds_, pushes_;  ///< by body
  Rows joints_, contacts_, frictions_, rolling_, penetrations_;
  std::vector<RigidSide> others_;
  std::vector<const btScalar*> pressures_;               ///< by index in the pool of contacts
  std::vector<int> order_, level_, next_, bodys_level_;  ///< of Arrange()
};

}  // namespace prehend::physics
