// SPDX-License-Identifier: Apache-2.0
// Speeds are read from the bodies once per manifold. Tested by tests/physics/world/bounce_test.cc
#include "physics/bullet/core/restitution.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace prehend::physics {
namespace {

/// Motion of one side of a contact. A hand's link counts as still: hands do not bounce.
struct Motion {
  explicit Motion(const btCollisionObject& object) {
    const btRigidBody* const body = btRigidBody::upcast(&object);
    if (!body) return;
    centre_W = body->getWorldTransform().getOrigin();
    v = body->getLinearVelocity();
    w = body->getAngularVelocity();
  }
  btVector3 At(const btVector3& p_W) const { return v + w.cross(p_W - centre_W); }

  btVector3 centre_W{0, 0, 0}, v{0, 0, 0}, w{0, 0, 0};
};

btScalar SpeedTogether(const Motion& a, const Motion& b, const btManifoldPoint& point) {
  return (b.At(point.getPositionWorldOnB()) - a.At(point.getPositionWorldOnA()))
      .dot(point.m_normalWorldOnB);
}

}  // namespace

btScalar ApproachSpeed(const btPersistentManifold& manifold, const btManifoldPoint& point) {
  return SpeedTogether(Motion(*manifold.getBody0()), Motion(*manifold.getBody1()), point);
}

TimelyBounces::TimelyBounces(btPersistentManifold* const* manifolds, int count, btScalar dt_s,
                             btScalar slowest_m_per_s) {
  for (int m = 0; m < count; ++m) {
    const Motion a(*manifolds[m]->getBody0()), b(*manifolds[m]->getBody1());
    for (int k = 0; k < manifolds[m]->getNumContacts(); ++k) {
      btManifoldPoint& point = manifolds[m]->getContactPoint(k);
      const btScalar speed = SpeedTogether(a, b, point);
      if (speed < -slowest_m_per_s) point.m_appliedImpulse = 0;
      if (point.m_combinedRestitution <= 0 || point.getDistance() <= 0) continue;
      if (speed < slowest_m_per_s) continue;
      if (point.getDistance() <= speed * dt_s) {
        point.setDistance(0);  // Bullet computes it anew in every tick
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
