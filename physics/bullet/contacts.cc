// SPDX-License-Identifier: Apache-2.0
// Leaves out contacts between grains of one body and contacts between bodies that rest. Tested by
// tests/physics/world/world_test.cc
// A convex sweep of Bullet. Tested by tests/physics/person/gaze_test.cc
#include "physics/bullet/contacts.h"

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include "physics/bullet/body.h"

namespace prehend::physics {

namespace {

class SightCallback final : public btCollisionWorld::ClosestConvexResultCallback {
 public:
  SightCallback(const ContactSides& sides, const SightLine& line, const btVector3& from,
                const btVector3& to)
      : ClosestConvexResultCallback(from, to), sides_(sides), line_(line) {
    m_collisionFilterGroup = -1;  // every body can be seen, persons included
    m_collisionFilterMask = -1;
  }

  btScalar addSingleResult(btCollisionWorld::LocalConvexResult& result,
                           bool normal_in_world) override {
    const int shape = result.m_localShapeInfo ? result.m_localShapeInfo->m_triangleIndex : 0;
    const ContactSide& side = SideOf(sides_, *result.m_hitCollisionObject, shape);
    if (side.body >= line_.ignore_from && side.body < line_.ignore_to) return m_closestHitFraction;
    side_ = side;
    return ClosestConvexResultCallback::addSingleResult(result, normal_in_world);
  }

  const ContactSide& side() const { return side_; }

 private:
  const ContactSides& sides_;
  const SightLine& line_;
  ContactSide side_;
};

}  // namespace

Sight FirstInSight(const btCollisionWorld& world, const ContactSides& sides,
                   const SightLine& line) {
  const btVector3 from = ToBullet(line.from_W_m),
                  to = ToBullet(Eigen::Vector3d(line.from_W_m + line.length_m * line.toward_W));
  const btSphereShape ball(line.radius_m);
  SightCallback callback(sides, line, from, to);
  world.convexSweepTest(&ball, btTransform(btQuaternion::getIdentity(), from),
                        btTransform(btQuaternion::getIdentity(), to), callback);
  if (!callback.hasHit()) return {};
  return {callback.side().body, callback.side().hand,
          callback.m_closestHitFraction * line.length_m};
}

const ContactSide& SideOf(const ContactSides& sides, const btCollisionObject& object, int shape) {
  const auto& of_object = sides[static_cast<std::size_t>(object.getUserIndex())];
  return of_object[of_object.size() == 1 ? 0 : static_cast<std::size_t>(shape)];
}

void ReadContacts(const btManifoldArray& manifolds, const ContactSides& sides,
                  TouchingPairs& pairs) {
  for (int m = 0; m < manifolds.size(); ++m) {
    const btPersistentManifold& manifold = *manifolds[m];
    // Grains of one body touch each other in every tick; these contacts are not reported.
    if (manifold.getBody0()->getUserIndex() == manifold.getBody1()->getUserIndex()) continue;
    // All shapes of one collision object rest or move together: the first one decides.
    if (pairs.Rest(SideOf(sides, *manifold.getBody0(), 0), SideOf(sides, *manifold.getBody1(), 0)))
      continue;
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
      const btManifoldPoint& point = manifold.getContactPoint(k);
      // Bullet's normal points from body 1 into body 0.
      pairs.Add({.a = SideOf(sides, *manifold.getBody0(), point.m_index0),
                 .b = SideOf(sides, *manifold.getBody1(), point.m_index1),
                 .p_W_m = FromBullet(point.getPositionWorldOnB()),
                 .nhat_BA_W = FromBullet(point.m_normalWorldOnB),
                 .distance_m = point.getDistance(),
                 .normal_impulse_n_s = point.getAppliedImpulse()});
    }
  }
}

}  // namespace prehend::physics
