// SPDX-License-Identifier: Apache-2.0
// Bodies that touch only what does not move: a thing on a table. No row has two of them, so each is
// solved by itself, all iterations at once, several of them side by side. The bits are those of
// RigidRows, which solves all others. Only for physics/bullet/core. Tested by
// tests/physics/bullet/single_bodies_test.cc
#pragma once

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/ConstraintSolver/btSolverBody.h>

#include <array>
#include <cstring>
#include <vector>

#include "physics/bullet/core/multibody_inertia.h"
#include "physics/bullet/lanes/kernels.h"

namespace prehend::physics {

// What a row of the solver reads and changes of one rigid body. Only for physics/bullet/core.
// Tested by tests/physics/bullet/solver_test.cc

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

class SingleBodies {
 public:
  /// Of Bullet's bodies those that are marked as `single`, with their `speeds`, and of its rows
  /// those that have such a body. They must outlive the other calls.
  void Setup(const std::vector<char>& single, const btAlignedObjectArray<btSolverBody>& bodies,
             std::vector<Six>& speeds, const btConstraintArray& contacts,
             const btConstraintArray& frictions);

  /// Solves each row `iterations` times, or until nothing changes any more; the bits do not depend
  /// on the processor.
  void Solve(int iterations) { Solve(iterations, BestKernels()); }
  void Solve(int iterations, const Kernels& kernels);
  /// Writes impulses to Bullet's rows.
  void WriteBack() const;

 private:
  /// Bullet's rows of a contact.
  struct Contact {
    const btSolverConstraint *normal = nullptr, *first_friction, *second_friction;
  };
  struct Body {
    int index;
    const btSolverBody* body;
    Six* speeds;
    std::size_t first, count;  ///< of contacts_
  };
  template <std::size_t lanes>
  struct Block {
    std::array<Six*, lanes> speeds;
    std::size_t first, count;  ///< of Blocks::contacts
  };
  template <std::size_t lanes>
  struct Blocks {
    std::vector<Block<lanes>> blocks;
    std::vector<SingleContacts<lanes>> contacts;
    std::vector<std::array<Contact, lanes>> sources;  ///< of contacts

    void Clear();
    /// At most as many bodies as there are lanes, the one with most contacts first.
    void Add(const Body* bodies, std::size_t count, const std::vector<Contact>& contacts);
    void Solve(Kernels::SolveSingle<lanes> kernel, int iterations);
    void WriteBack() const;
  };
  static RigidSide SideOf(const Body& body, const btSolverConstraint& source);
  template <std::size_t lanes>
  static void SetRow(SingleRow<lanes>& row, std::size_t lane, const RigidSide& side,
                     const btSolverConstraint& source);
  template <std::size_t lanes>
  static void SetContact(SingleContacts<lanes>& contacts, std::size_t lane, const Body& body,
                         const Contact& contact);
  void Arrange();

  std::vector<std::size_t> place_;  ///< by body: of its next contact
  std::vector<Body> bodies_;
  std::vector<Contact> contacts_;  ///< by body
  Blocks<8> eight_;
  Blocks<4> four_;
  Blocks<2> two_;
};

}  // namespace prehend::physics
