// SPDX-License-Identifier: Apache-2.0
// Bullet's solver of multibodies, made faster for hands (physics/bullet/core/rigid_rows.h does the
// same for rigid bodies). Same rows and same arithmetic, except for friction, which is limited by a
// circle (physics/bullet/core/friction_circle.h), and for bodies that bounce. Every row is first
// written out flat, with the few non-zero elements of its Jacobian (a joint motor has one, a
// finger's contact 10 of 22); rows whose impulse does not change write nothing; and velocities are
// written to the multibody once per step. Tested by tests/physics/bullet/solver_test.cc
#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>

#include <vector>

#include "physics/bullet/core/rigid_rows.h"

namespace prehend::physics {

/// Sorts manifolds by the numbers of their bodies, which follow the order in which the scene was
/// built. Bullet sorts them by island only, with a sort that is not stable.
void PlaceInOrder(btPersistentManifold** manifolds, int count);

/// Projected Gauss-Seidel over the rows of btMultiBodyConstraintSolver; the two friction rows of a
/// contact are solved together. Requires two friction directions, and `m_numIterations` iterations
/// for every row.
class BulletSolver final : public btMultiBodyConstraintSolver {
 public:
  btScalar solveGroupCacheFriendlySetup(btCollisionObject** bodies, int body_count,
                                        btPersistentManifold** manifolds, int manifold_count,
                                        btTypedConstraint** constraints, int constraint_count,
                                        const btContactSolverInfo& info,
                                        btIDebugDraw* drawer) override;
  void solveGroupCacheFriendlySplitImpulseIterations(
      btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
      int manifold_count, btTypedConstraint** constraints, int constraint_count,
      const btContactSolverInfo& info, btIDebugDraw* drawer) override;
  /// Bullet's version of PlaceInOrder()'s order, within TimelyBounces
  /// (physics/bullet/core/restitution.h).
  void convertContacts(btPersistentManifold** manifolds, int count,
                       const btContactSolverInfo& info) override;
  /// Largest squared change of an impulse of all rows; zero if nothing changed.
  btScalar solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                btPersistentManifold** manifolds, int manifold_count,
                                btTypedConstraint** constraints, int constraint_count,
                                const btContactSolverInfo& info, btIDebugDraw* drawer) override;
  btScalar solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int body_count,
                                         const btContactSolverInfo& info) override;

 private:
  /// A non-zero element of a Jacobian.
  struct Term {
    int speed;  ///< index into m_data.m_deltaVelocities
    btScalar factor;
  };
  /// One of the two bodies of a row: a multibody, a rigid body, or none.
  struct Side {
    int first_term = 0, end_term = 0;  ///< in terms_
    int speeds = 0;                    ///< of the multibody, in m_data.m_deltaVelocities
    int response = 0;     ///< to a unit impulse, in m_data.m_deltaVelocitiesUnitImpulse
    int speed_count = 0;  ///< degrees of freedom; 0 unless it is a multibody
    RigidSide rigid;
  };
  struct Row {
    Side a, b;
    btScalar wanted, softness, inverse_mass, least, most, friction;
    btScalar impulse;
    int normal;  ///< of a friction row: index of its contact row
    btMultiBodySolverConstraint* source;
  };
  using Rows = std::vector<Row>;

  RigidRows::Pools RigidPools();
  void Flatten(btMultiBodyConstraintArray& sources, Rows& rows);
  Side MakeSide(btMultiBody* multibody, int solver_body, int jacobian, int speeds,
                const btVector3& linear, const btVector3& angular,
                const btVector3& angular_response);
  btScalar SpeedAlong(const Side& side) const;
  /// Impulse of the contact of a friction row.
  btScalar Pressure(const Row& friction) const;
  btScalar WantedChange(const Row& row) const;
  void Push(const Side& side, btScalar impulse);
  void Push(const Row& row, btScalar impulse);
  btScalar Solve(Row& row);
  /// Change of speed along the row of `first` by a unit impulse along the row of `second`.
  btScalar Coupling(const Side& first, const Side& second) const;
  void ComputeCouplings(const Rows& pairs, std::vector<btScalar>& couplings) const;
  btScalar SolvePair(Row& first, Row& second, btScalar coupling);
  btScalar SolvePairs(Rows& rows, const std::vector<btScalar>& couplings, bool only_pressed);
  /// Remembers where this multibody's speeds are.
  void RegisterMultibody(btMultiBody& multibody, int speeds);

  struct MultibodyUse {
    btMultiBody* multibody;
    int speeds;  ///< index of its first in m_data.m_deltaVelocities
  };
  RigidRows rigid_;
  Rows joints_, normals_, frictions_, rolling_, spinning_;
  std::vector<btScalar> friction_couplings_, rolling_couplings_;  ///< by pair of rows
  std::vector<Term> terms_;
  std::vector<MultibodyUse> multibodies_;
};

}  // namespace prehend::physics
