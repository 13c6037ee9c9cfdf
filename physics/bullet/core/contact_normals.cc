// SPDX-License-Identifier: Apache-2.0
// Tested by tests/physics/world/tipping_test.cc
#include "physics/bullet/core/contact_normals.h"

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

namespace prehend::physics {
namespace {

/// Ours among the flags of a point: it was there before this tick. A point that is found anew has
/// none of them.
constexpr int kKept = 1 << 16;

std::size_t IndexOf(const btCollisionObject& body) {
  return static_cast<std::size_t>(body.getWorldArrayIndex());
}

/// Of a hand. Its points stay as Bullet keeps them: fingers press, so that points are found anew
/// all the time.
bool IsLink(const btCollisionObject& body) {
  return body.getInternalType() == btCollisionObject::CO_FEATHERSTONE_LINK;
}

/// The shorter of two ways that go the same way, else none.
btVector3 Shared(const btVector3& a, const btVector3& b) {
  if (a.dot(b) <= 0) return {0, 0, 0};
  return a.length2() < b.length2() ? a : b;
}

}  // namespace

bool CarriedNormals::Turned(const btCollisionObject& body) const {
  const std::size_t i = IndexOf(body);
  return !IsLink(body) && i < before_.size() && before_[i].known &&
         !(before_[i].R_WB == body.getWorldTransform().getBasis());
}

btVector3 CarriedNormals::WayOf(const btVector3& normal, const btCollisionObject& body) const {
  return body.getWorldTransform().getBasis() * (normal * before_[IndexOf(body)].R_WB) - normal;
}

void CarriedNormals::Carry(btPersistentManifold& manifold) const {
  const btCollisionObject &a = *manifold.getBody0(), &b = *manifold.getBody1();
  const bool both_turned = Turned(a) && Turned(b);
  for (int k = 0; k < manifold.getNumContacts(); ++k) {
    btManifoldPoint& point = manifold.getContactPoint(k);
    btVector3& normal = point.m_normalWorldOnB;
    if (both_turned && (point.m_contactPointFlags & kKept)) {
      const btVector3 way = Shared(WayOf(normal, a), WayOf(normal, b));
      if (!way.isZero()) {
        normal = (normal + way).normalized();
        point.setDistance((point.getPositionWorldOnA() - point.getPositionWorldOnB()).dot(normal));
      }
    }
    point.m_contactPointFlags |= kKept;
  }
}

void CarriedNormals::Remember(const btCollisionObject& body) {
  const std::size_t i = IndexOf(body);
  if (i >= before_.size()) before_.resize(i + 1);
  before_[i] = {body.getWorldTransform().getBasis(), true};
}

}  // namespace prehend::physics
