// SPDX-License-Identifier: Apache-2.0
// Tested by tests/physics/bounce_test.cc
#include "physics/bullet_bounces.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace prehend::physics {
namespace {

btVector3 VelocityAt(const btCollisionObject& object, const btVector3& p_W) {
  const btRigidBody* body = btRigidBody::upcast(&object);
  return body ? body->getVelocityInLocalPoint(p_W - body->getWorldTransform().getOrigin())
              : btVector3(0, 0, 0);  // a hand's link: hands do not bounce
}

}  // namespace

btScalar ApproachSpeed(const btPersistentManifold& manifold, const btManifoldPoint& point) {
  return (VelocityAt(*manifold.getBody1(), point.getPositionWorldOnB()) -
          VelocityAt(*manifold.getBody0(), point.getPositionWorldOnA()))
      .dot(point.m_normalWorldOnB);
}

TimelyBounces::TimelyBounces(btPersistentManifold* const* manifolds, int count, btScalar dt_s,
                             btScalar slowest_m_per_s) {
  for (int m = 0; m < count; ++m) {
    for (int k = 0; k < manifolds[m]->getNumContacts(); ++k) {
      btManifoldPoint& point = manifolds[m]->getContactPoint(k);
      const btScalar speed = ApproachSpeed(*manifolds[m], point);
      if (speed < -slowest_m_per_s) point.m_appliedImpulse = 0;
      if (point.m_combinedRestitution <= 0 || point.getDistance() <= 0) continue;
      if (speed < slowest_m_per_s) continue;
      if (point.getDistance() <= speed * dt_s) {
        point.setDistance(0);  // computed anew in every tick
      } else {
        later_.emplace_back(&point, point.m_combinedRestitution);
        point.m_combinedRestitution = 0;
      }
    }
  }
}

TimelyBounces::~TimelyBounces() {
  for (const auto& [point, restitution] : later_) point->m_combinedRestitution = restitution;
}

}  // namespace prehend::physics
