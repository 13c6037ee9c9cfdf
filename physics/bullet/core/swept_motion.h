// SPDX-License-Identifier: Apache-2.0
// Stops bodies that would come out on the other side of another one within a tick. Bullet looks for
// contacts where bodies are at the end of a tick: a knife that moves 9 mm per tick is above a board
// of 4 mm in one tick, and below it in the next. Only for physics/bullet. Tested by
// tests/physics/world/swept_motion_test.cc
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletCollision/CollisionShapes/btConvexShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <vector>

namespace prehend::physics {

struct Gap {
  bool is_known = false;
  btScalar distance_m = 0;
  btVector3 n_BA_W, p_W;  ///< from B to A; on B
};

Gap GapBetween(const btConvexShape& a, const btTransform& X_WA, const btConvexShape& b,
               const btTransform& X_WB);

/// One convex part of a body.
struct Part {
  const btConvexShape* shape;
  btTransform X_BP;
};

/// In the order of a compound's shapes.
std::vector<Part> PartsOf(const btCollisionShape& shape);

class SweptMotion {
 public:
  explicit SweptMotion(btCollisionWorld& world) : world_(world) {}

  /// Call when the speeds of a tick are known, and before bodies move with them. `awake` are the
  /// bodies that will move.
  void Find(const btAlignedObjectArray<btRigidBody*>& awake, btScalar dt_s);
  /// Call when they have moved: puts those that have met something back to where they touch it.
  /// The next tick finds the contact; until then they lose less than a tick.
  void Hold();

 private:
  /// A body that moves far in this tick, or met one that does.
  struct Held {
    btRigidBody* body;
    btTransform X_WB;  ///< where it touches
    btScalar share;    ///< of its way in this tick, until then
  };

  void Measure();
  void FindFirst(btRigidBody& body);
  void HoldAt(btRigidBody& body, btScalar share);

  btCollisionWorld& world_;
  btScalar dt_s_ = 0;
  btScalar thinnest_m_ = 0;  ///< half of the smallest thickness in the world
  btScalar farthest_m_ = 0;  ///< the longest way of a body in this tick
  std::vector<btRigidBody*> fast_;
  std::vector<Held> held_;
};

}  // namespace prehend::physics
