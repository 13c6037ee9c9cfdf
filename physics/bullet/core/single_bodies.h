// SPDX-License-Identifier: Apache-2.0
// Bodies that touch only what does not move: a thing on a table. No row has two of them, so each is
// solved by itself, all iterations at once, several of them side by side. The bits are those of
// RigidRows, which solves all others. Only for physics/bullet/core. Tested by
// tests/physics/bullet/single_bodies_test.cc
#pragma once

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>

#include <array>
#include <vector>

#include "physics/bullet/core/rigid_side.h"
#include "physics/bullet/lanes/kernels.h"

namespace prehend::physics {

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
