// SPDX-License-Identifier: Apache-2.0
// A convex sweep of Bullet. Tested by tests/physics/person/gaze_test.cc
#include "physics/bullet/sight_ray.h"

#include "physics/bullet/convert.h"

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

}  // namespace prehend::physics
