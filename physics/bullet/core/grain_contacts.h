// SPDX-License-Identifier: Apache-2.0
// Contacts between the grains of one body: found by cells of a grid instead of Bullet's broad
// phase, narrow phase and manifolds. Only for physics/bullet. Tested by
// tests/physics/bullet/grain_contacts_test.cc
#pragma once

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <cstdint>
#include <vector>

namespace prehend::physics {

/// Second user index of a grain. All grains with the same first user index, which must be added one
/// after the other, are equal spheres.
constexpr int kGrain = 1;

/// Contacts of grains, with each other or with another body, are solved in every second iteration.
/// Those with each other converge faster than Bullet's rows, because friction follows its contact's
/// normal at once: a heap of 200 overlaps less than in stock Bullet, which solves all rows in each
/// of 50 iterations (tests/physics/bullet/grain_contacts_test.cc).
constexpr int kGrainPeriod = 2;

/// Two spheres that touch, or that touched in the last tick and are still as near as Bullet keeps
/// contact points.
struct GrainContact {
  std::uint64_t place;  ///< in the order of contacts: by heap, then by a, then by b
  btRigidBody *a, *b;
  btVector3 normal;  ///< from b to a
  btScalar gap_m;    ///< negative: they overlap
  btScalar impulse;  ///< along the normal, of the last tick
};

class GrainContacts {
 public:
  /// Whether contacts of these two belong here. Grains with rolling friction are left to Bullet.
  static bool Own(const btCollisionObject& a, const btCollisionObject& b);

  /// Call for every grain before the first Find(); other bodies are ignored.
  void Add(btRigidBody& body);
  /// Finds the contacts of a tick, in the order in which grains were added. Contacts of heaps that
  /// sleep stay as they are.
  void Find();
  /// Of all heaps.
  std::vector<GrainContact>& contacts() { return contacts_; }

 private:
  struct Heap {
    int user_index;
    btScalar radius_m;
    std::vector<btRigidBody*> grains;
  };
  struct Cell {
    std::uint64_t key;
    std::uint32_t grain;
  };
  void FindNear(std::size_t heap);
  void AddIfNear(std::size_t heap, std::uint32_t i, std::uint32_t j);
  /// Keeps what touches, and what touched and is still near.
  void KeepTouching();

  std::vector<Heap> heaps_;
  std::vector<GrainContact> contacts_, before_;
  std::vector<Cell> cells_;
};

/// Keeps pairs that GrainContacts owns out of Bullet's broad phase.
class GrainFilter final : public btOverlapFilterCallback {
 public:
  bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override;
};

}  // namespace prehend::physics
