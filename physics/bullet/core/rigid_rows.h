// SPDX-License-Identifier: Apache-2.0
// The rows between rigid bodies of btSequentialImpulseConstraintSolver, made faster. Same rows,
// same arithmetic, except that friction and rolling friction are limited by circles
// (physics/bullet/lanes/friction_circle.h). Every row is first written out flat, a side that does
// not move costs nothing, and rows without a common body are adjacent, so that none waits for its
// neighbour's result. Bodies that touch only what does not move are left to SingleBodies. Tested by
// tests/physics/bullet/solver_test.cc
#pragma once

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>

#include <vector>

#include "physics/bullet/core/single_bodies.h"
#include "physics/bullet/lanes/friction_circle.h"

namespace prehend::physics {

/// Requires rows in a fixed order, friction rows after all contact rows (Bullet's defaults), and
/// two friction directions.
class RigidRows {
 public:
  /// Bullet's rows of one group of islands; they must outlive the other calls.
  struct Pools {
    btAlignedObjectArray<btSolverBody>& bodies;
    btConstraintArray &joints, &contacts, &frictions, &rolling;
    const std::vector<char>& shared;  ///< by body: other rows change its speeds, too
  };
  /// To be called before Setup().
  void FindSingleBodies(const Pools& pools);
  /// Whether no hand touches one of its bodies, which moves and also touches something else that
  /// does. Not of grains.
  bool MayCreep(const btSolverConstraint& contact, const Pools& pools) const;
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
    int repeats;               ///< in each iteration
    bool grain;                ///< one of the bodies is a grain
    const btSolverConstraint* source;
  };
  using Rows = std::vector<Row>;

  bool IsSingle(const btSolverConstraint& source) const;
  /// Computes the order of groups of `group` rows, which have the same bodies. Groups with a common
  /// body keep their order, and so do the rows of a group. Groups of single bodies are left out.
  void Arrange(const btConstraintArray& sources, std::size_t group,
               const btAlignedObjectArray<btSolverBody>& bodies);
  void Flatten(const Pools& pools, const btConstraintArray& sources, std::size_t group, Rows& rows);
  /// How often the rows of each body are solved per iteration: more often those of a body that
  /// bears much heavier ones, which converge slowly. Not of what a hand touches, too.
  void FindRepeats(const Pools& pools);
  btScalar SolveContacts(int repeat, bool with_grains);
  Row MakeRow(const btSolverConstraint& source, const Pools& pools, std::vector<Six>& speeds);
  void TakePenetrations(const Pools& pools);
  [[gnu::always_inline]] const RigidSide* OtherOf(const Row& row) const;
  /// Change of the impulse that gives the wanted speed, without limits.
  [[gnu::always_inline]] btScalar WantedChange(const Row& row) const;
  [[gnu::always_inline]] void Push(Row& row, btScalar change);
  [[gnu::always_inline]] btScalar Solve(Row& row);
  btScalar Coupling(const Row& first, const Row& second) const;
  /// Two rows of friction of one contact, whose impulses together are at most `limit`.
  btScalar SolvePair(Row& first, Row& second, btScalar limit, const PrincipalResponse& response);

  std::vector<Six> speeds_, pushes_;  ///< by body
  using Responses = std::vector<PrincipalResponse>;
  /// Of the last two of every `group` rows.
  void ComputeResponses(const Rows& rows, std::size_t group, Responses& responses) const;

  std::vector<char> single_;  ///< by body
  std::vector<int> repeats_;  ///< by body
  int most_repeats_ = 1;
  SingleBodies single_bodies_;
  Rows joints_, contacts_, frictions_, rolling_, penetrations_;
  Responses friction_responses_, rolling_responses_;  ///< by pair of rows
  btScalar grains_change_ = 0;  ///< largest squared change of a speed, when they were last solved
  std::vector<RigidSide> others_;
  std::vector<const btScalar*> pressures_;               ///< by index in the pool of contacts
  std::vector<int> order_, level_, next_, bodys_level_;  ///< of Arrange()
};

}  // namespace prehend::physics
