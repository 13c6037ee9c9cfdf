// SPDX-License-Identifier: Apache-2.0
// Sorts pairs by the ids of their proxies, as Bullet does. Tested by
// tests/physics/world/world_test.cc
#include "physics/bullet/core/dispatcher.h"

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <algorithm>
#include <utility>

namespace prehend::physics {
namespace {

const btCollisionObject& BodyOf(const btBroadphaseProxy& proxy) {
  return *static_cast<const btCollisionObject*>(proxy.m_clientObject);
}

bool Active(const btBroadphaseProxy& proxy) { return BodyOf(proxy).isActive(); }

std::pair<int, int> Ids(const btBroadphasePair* pair) {
  return {pair->m_pProxy0->m_uniqueId, pair->m_pProxy1->m_uniqueId};
}

}  // namespace

void BulletDispatcher::dispatchAllCollisionPairs(btOverlappingPairCache* cache,
                                                 const btDispatcherInfo& info, btDispatcher*) {
  awake_.clear();
  btBroadphasePairArray& pairs = cache->getOverlappingPairArray();
  for (int i = 0; i < pairs.size(); ++i) {
    if (Active(*pairs[i].m_pProxy0) || Active(*pairs[i].m_pProxy1)) awake_.push_back(&pairs[i]);
  }
  std::ranges::sort(awake_, std::greater<>(), Ids);
  for (btBroadphasePair* pair : awake_) getNearCallback()(*pair, *this, info);
  const btManifoldArray& manifolds = AwakeManifolds();
  for (int i = 0; i < manifolds.size(); ++i) normals_.Carry(*manifolds[i]);
  for (const btBroadphasePair* pair : awake_) {
    normals_.Remember(BodyOf(*pair->m_pProxy0));
    normals_.Remember(BodyOf(*pair->m_pProxy1));
  }
}

const btManifoldArray& BulletDispatcher::AwakeManifolds() {
  manifolds_.resize(0);
  for (const btBroadphasePair* pair : awake_)
    if (pair->m_algorithm) pair->m_algorithm->getAllContactManifolds(manifolds_);
  return manifolds_;
}

const btManifoldArray& BulletDispatcher::AllManifolds() {
  manifolds_ = m_manifoldsPtr;
  return manifolds_;
}

}  // namespace prehend::physics
