// SPDX-License-Identifier: Apache-2.0
// Sorts pairs by the ids of their proxies, as Bullet does. Tested by
// tests/physics/world/world_test.cc
#include "physics/bullet/core/dispatcher.h"

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <algorithm>
#include <functional>

namespace prehend::physics {
namespace {

const btCollisionObject& BodyOf(const btBroadphaseProxy& proxy) {
  return *static_cast<const btCollisionObject*>(proxy.m_clientObject);
}

bool Active(const btBroadphaseProxy& proxy) { return BodyOf(proxy).isActive(); }

std::uint64_t Ids(const btBroadphasePair& pair) {
  return static_cast<std::uint64_t>(pair.m_pProxy0->m_uniqueId) << 32 |
         static_cast<std::uint32_t>(pair.m_pProxy1->m_uniqueId);
}

}  // namespace

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
