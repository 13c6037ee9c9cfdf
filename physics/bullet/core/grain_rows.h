// SPDX-License-Identifier: Apache-2.0
// The rows of contacts between grains: equal spheres, for which most of a row is known beforehand.
// A normal impulse turns neither of two spheres, and their friction resists sliding equally in all
// directions, so that its circle (physics/bullet/lanes/friction_circle.h) is met by scaling. Only
// for physics/bullet. Tested by tests/physics/bullet/grain_contacts_test.cc
#pragma once

#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>

#include <array>
#include <vector>

#include "physics/bullet/core/grain_contacts.h"
#include "physics/bullet/core/rigid_rows.h"
#include "physics/bullet/lanes/kernels.h"

namespace prehend::physics {

/// Projected Gauss-Seidel like RigidRows, of whose speeds it works on: for each contact the normal,
/// then the friction.
class GrainRows {
 public:
  /// Takes the contacts whose grains are among `bodies`, Bullet's bodies of one group of islands.
  void Setup(std::vector<GrainContact>& contacts, const btAlignedObjectArray<btSolverBody>& bodies,
             RigidRows& rigid, const btContactSolverInfo& info);
  /// Solves each contact once. Returns the largest squared change of a speed.
  btScalar Solve() { return Solve(BestKernels()); }
  btScalar Solve(const Kernels& kernels);
  /// The same for contacts that only correct penetration ("split impulse").
  btScalar SolvePenetrations();
  /// Hands the impulses to the next tick.
  void WriteBack() const;

 private:
  struct Row {
    Six *a, *b;            ///< the solver's change of their speeds
    btScalar n[3];         ///< from b to a
    btScalar wanted;       ///< speed along the normal
    btScalar slip[3];      ///< before the solver: speed of a against b, across the normal
    btScalar normal_mass;  ///< impulse by unit speed
    btScalar sliding_mass, sliding_response;  ///< the latter: speed by unit impulse
    btScalar inverse_mass;                    ///< of one grain
    btScalar turn;  ///< change of turning speed by a unit impulse across the normal
    btScalar radius, friction;
    btScalar impulse, sliding[3];  ///< impulses on a
    GrainContact* source;
  };
  struct Penetration {
    Six *a, *b;  ///< the solver's pushes
    btScalar n[3];
    btScalar wanted, normal_mass, inverse_mass, impulse;
  };
  static int SolverBodyOf(const btRigidBody& grain,
                          const btAlignedObjectArray<btSolverBody>& bodies);
  Row MakeRow(GrainContact& contact, const btSolverBody& a, const btSolverBody& b, Six& a_speeds,
              Six& b_speeds, const btContactSolverInfo& info) const;
  /// Distributes rows to blocks. Rows with a common grain keep their order.
  void Arrange(std::size_t body_count);
  static void Put(const Row& row, GrainBlock& block, std::size_t lane);

  std::vector<Row> rows_;
  std::vector<std::array<std::size_t, 2>> bodies_;  ///< of rows_
  std::vector<GrainBlock> blocks_;
  std::vector<std::array<GrainContact*, GrainBlock::kLanes>> sources_;  ///< of blocks_
  Six nothing_{};  ///< the speeds of lanes without a row
  std::vector<Penetration> penetrations_;
  std::vector<std::size_t> level_, next_, bodys_level_, first_block_;  ///< of Arrange()
};

}  // namespace prehend::physics
