// SPDX-License-Identifier: Apache-2.0
// Sorts pairs by the ids of their proxies, as Bullet does. Tested by
// tests/physics/world/world_test.cc
// A flag on each point tells kept points from new ones. Tested by
// tests/physics/world/tipping_test.cc
#include "physics/bullet/core/dispatcher.h"

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <algorithm>
#include <functional>

namespace prehend::physics {

namespace {

/// Our flag on a contact point: it existed before this tick. A new point has no flags.
constexpr int kKept = 1 << 16;

std::size_t IndexOf(const btCollisionObject& body) {
  return static_cast<std::size_t>(body.getWorldArrayIndex());
}

/// The shorter of two changes in the same direction, else zero.
btVector3 Shared(const btVector3& a, const btVector3& b) {
  if (a.dot(b) <= 0) return {0, 0, 0};
  return a.length2() < b.length2() ? a : b;
}

const btCollisionObject& BodyOf(const btBroadphaseProxy& proxy) {
  return *static_cast<const btCollisionObject*>(proxy.m_clientObject);
}

bool Active(const btBroadphaseProxy& proxy) { return BodyOf(proxy).isActive(); }

std::uint64_t Ids(const btBroadphasePair& pair) {
  return static_cast<std::uint64_t>(pair.m_pProxy0->m_uniqueId) << 32 |
         static_cast<std::uint32_t>(pair.m_pProxy1->m_uniqueId);
}

}  // namespace

bool CarriedNormals::Turned(const btCollisionObject& body) const {
  const std::size_t i = IndexOf(body);
  return i < before_.size() && before_[i].known &&
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

void BulletDispatcher::dispatchAllCollisionPairs(btOverlappingPairCache* cache,
                                                 const btDispatcherInfo& info, btDispatcher*) {
  awake_.clear();
  btBroadphasePairArray& pairs = cache->getOverlappingPairArray();
  for (int i = 0; i < pairs.size(); ++i) {
    if (Active(*pairs[i].m_pProxy0) || Active(*pairs[i].m_pProxy1))
      awake_.push_back({Ids(pairs[i]), &pairs[i]});
  }
  std::ranges::sort(awake_, std::greater<>(), &AwakePair::ids);
  for (const AwakePair& awake : awake_) getNearCallback()(*awake.pair, *this, info);
  awake_manifolds_.resize(0);
  for (const AwakePair& awake : awake_)
    if (awake.pair->m_algorithm) awake.pair->m_algorithm->getAllContactManifolds(awake_manifolds_);
  for (int i = 0; i < awake_manifolds_.size(); ++i) normals_.Carry(*awake_manifolds_[i]);
  for (const AwakePair& awake : awake_) {
    normals_.Remember(BodyOf(*awake.pair->m_pProxy0));
    normals_.Remember(BodyOf(*awake.pair->m_pProxy1));
  }
}

}  // namespace prehend::physics
