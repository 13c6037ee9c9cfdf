// SPDX-License-Identifier: Apache-2.0
// Bullet's solver of multibodies, made faster for hands (physics/bullet/core/rigid_rows.h does the
// same for rigid bodies). Same rows and same arithmetic, except for friction, which is limited by a
// circle (physics/bullet/lanes/friction_circle.h), and for bodies that bounce. Every row is first
// written out flat, with the few non-zero elements of its Jacobian (a joint motor has one, a
// finger's contact 10 of 22); rows whose impulse does not change write nothing; and velocities are
// written to the multibody once per step. Tested by tests/physics/bullet/solver_test.cc
#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>

#include <deque>
#include <vector>

#include "physics/bullet/core/friction_anchors.h"
#include "physics/bullet/core/grain_rows.h"
#include "physics/bullet/core/multibody_inertia.h"
#include "physics/bullet/core/rigid_rows.h"
#include "physics/bullet/lanes/friction_circle.h"

namespace prehend::physics {

/// Sorts manifolds by the numbers of their bodies, which follow the order in which the scene was
/// built. Bullet sorts them by island only, with a sort that is not stable.
void PlaceInOrder(btPersistentManifold** manifolds, int count);

/// Projected Gauss-Seidel over the rows of btMultiBodyConstraintSolver; the two friction rows of a
/// contact are solved together. Requires two friction directions, and `m_numIterations` iterations
/// for every row.
class BulletSolver final : public btMultiBodyConstraintSolver {
 public:
  BulletSolver() = default;
  /// Also solves these contacts, those of each group of islands with it; they must outlive this.
  explicit BulletSolver(GrainContacts& grains) : grain_contacts_(&grains) {}

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
  /// (physics/bullet/core/flat_impacts.h).
  void convertContacts(btPersistentManifold** manifolds, int count,
                       const btContactSolverInfo& info) override;
  /// Largest squared change of an impulse of all rows; zero if nothing changed.
  btScalar solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                btPersistentManifold** manifolds, int manifold_count,
                                btTypedConstraint** constraints, int constraint_count,
                                const btContactSolverInfo& info, btIDebugDraw* drawer) override;
  btScalar solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int body_count,
                                         const btContactSolverInfo& info) override;
  void allSolved(const btContactSolverInfo& info, btIDebugDraw* drawer) override;

 private:
  /// One of the two bodies of a row: a rigid body, a multibody (its base, which feels all that it
  /// carries, and the joints of a limb), or none.
  struct Side {
    RigidSide rigid;
    std::size_t first_joint = 0, joint_count = 0;  ///< in joint_speeds_
    /// Of the joints in coefficients_: elements of the Jacobian, then changes of speed by a unit
    /// impulse. Two joints are done at once: if their number is odd, one more has zeros.
    std::size_t coefficients = 0;
    std::size_t acts_from = 0, acts_to = 0;  ///< of the joints those that the row acts on
  };
  struct Row {
    Side a, b;
    btScalar wanted;    ///< speed
    btScalar softness;  ///< speed by a unit impulse, which the row gives way
    btScalar inverse_mass, least, most, friction;
    btScalar impulse;
    int normal;  ///< of a friction row: index of its contact row
    btMultiBodySolverConstraint* source;
  };
  using Rows = std::vector<Row>;

  RigidRows::Pools RigidPools();
  /// Marks rigid bodies that take part in rows of a multibody.
  void FindShared();
  /// Makes rows without a common body neighbours, so that none waits for its neighbour's result.
  /// Rows with a common body keep their order, and with it every bit of the results.
  void Interleave(Rows& rows);
  void Flatten(btMultiBodyConstraintArray& sources, Rows& rows);
  template <class Constraint>
  FrictionAnchors::Drift AddAnchor(const Constraint& contact, const FrictionAnchors::Side& a,
                                   const FrictionAnchors::Side& b);
  FrictionAnchors::Side RigidSideOf(int body) const;
  /// Friction also removes the way by which contacts that stick have drifted.
  void HoldRigidAnchors(const btContactSolverInfo& info);
  void HoldAnchors(const btContactSolverInfo& info);
  void ForgetSlidingAnchors();
  Side MakeSide(btMultiBody* multibody, int solver_body, int jacobian, int speeds,
                const btVector3& linear, const btVector3& angular,
                const btVector3& angular_response);
  Side MakeSide(btMultiBody& multibody, int place, int speeds);
  [[gnu::always_inline]] btScalar SpeedAlong(const Side& side) const;
  /// Impulse of the contact of a friction row.
  btScalar Pressure(const Row& friction) const;
  /// Wanted minus present speed along the row.
  [[gnu::always_inline]] btScalar SpeedError(const Row& row) const;
  [[gnu::always_inline]] void Push(const Side& side, btScalar impulse);
  [[gnu::always_inline]] void Push(const Row& row, btScalar impulse);
  btScalar Solve(Row& row);
  /// Change of speed along the row of `first` by a unit impulse along the row of `second`.
  btScalar Coupling(const Side& first, const Side& second) const;
  using Responses = std::vector<PrincipalResponse>;
  void ComputeResponses(const Rows& pairs, Responses& responses) const;
  btScalar SolvePair(Row& first, Row& second, const PrincipalResponse& response);
  btScalar SolvePairs(Rows& rows, const Responses& responses, bool only_pressed);

  /// The solver's change of the speeds of a multibody, in the variables of MultibodyInertia.
  struct MultibodyUse {
    btMultiBody* multibody;
    const MultibodyInertia* inertia;
    int speeds;  ///< index of the first in m_data.m_deltaVelocities, where Bullet wants the sum
    std::size_t first_joint;  ///< in joint_speeds_
    Six base{};
  };
  MultibodyUse& UseOf(btMultiBody& multibody, int speeds);
  void ApplySpeeds(const MultibodyUse& use);

  std::vector<char> shared_;  ///< by rigid body
  RigidRows rigid_;
  GrainContacts* grain_contacts_ = nullptr;
  GrainRows grains_;
  btScalar grains_change_ = 0;  ///< largest squared change of a speed, of the last time
  Rows interleaved_;
  Rows joints_, normals_, frictions_, rolling_, spinning_;
  Responses friction_responses_, rolling_responses_;  ///< by pair of rows
  FrictionAnchors anchors_;
  std::vector<FrictionAnchors::Drift> drifts_;  ///< by contact
  std::size_t first_anchor_ = 0;                ///< of this group's contacts with hands
  struct RigidAnchor {
    int contact;
    std::size_t anchor;
  };
  std::vector<RigidAnchor> rigid_anchors_;
  MultibodyInertias inertias_;
  std::deque<MultibodyUse> multibodies_;
  std::vector<btScalar> joint_speeds_, coefficients_;
};

}  // namespace prehend::physics
