// SPDX-License-Identifier: Apache-2.0
// Tested by tests/physics/world_test.cc
#include "physics/bullet_contacts.h"

#include <algorithm>
#include <tuple>

#include "physics/bullet_convert.h"

namespace prehend::physics {
namespace {

/// Bullet keeps points up to 20 mm apart; larger values here would report contacts before they
/// happen.
constexpr double kTouchDistance_m = 0.0005;
/// A pair that stops pushing for no longer than this still touches: 8 ms at 480 Hz.
constexpr int kHoldTicks = 4;

/// `shape` is the index that Bullet gives to a compound's shape at a point.
const ContactSide& SideOf(const ContactSides& sides, const btCollisionObject& object, int shape) {
  const auto& of_object = sides[static_cast<std::size_t>(object.getUserIndex())];
  return of_object[of_object.size() == 1 ? 0 : static_cast<std::size_t>(shape)];
}

ContactPoint MakePoint(const btManifoldPoint& point, const ContactSide& side0,
                       const ContactSide& side1) {
  // Bullet's normal points from body 1 into body 0.
  const bool in_order = side0 < side1;
  const Eigen::Vector3d normal = FromBullet(point.m_normalWorldOnB);
  return {.a = in_order ? side0 : side1,
          .b = in_order ? side1 : side0,
          .p_W_m = FromBullet(point.getPositionWorldOnB()),
          .nhat_BA_W = in_order ? normal : Eigen::Vector3d(-normal),
          .distance_m = point.getDistance(),
          .normal_impulse_n_s = point.getAppliedImpulse()};
}

bool PointLess(const ContactPoint& l, const ContactPoint& r) {
  return std::tuple(l.p_W_m.x(), l.p_W_m.y(), l.p_W_m.z()) <
         std::tuple(r.p_W_m.x(), r.p_W_m.y(), r.p_W_m.z());
}

}  // namespace

void BulletContacts::Read(const btDispatcher& const_dispatcher) {
  // The manifold accessor is not const in Bullet, though it changes nothing.
  auto& dispatcher = const_cast<btDispatcher&>(const_dispatcher);
  for (auto& [key, pair] : pairs_) pair.seen = false;
  for (int m = 0; m < dispatcher.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(m);
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
      const btManifoldPoint& point = manifold.getContactPoint(k);
      if (point.getDistance() >= kTouchDistance_m || point.getAppliedImpulse() <= 0) continue;
      const ContactSide& side0 = SideOf(sides_, *manifold.getBody0(), point.m_index0);
      const ContactSide& side1 = SideOf(sides_, *manifold.getBody1(), point.m_index1);
      Pair& pair = pairs_[std::minmax(side0, side1)];
      if (!pair.seen) pair = {.points = {}, .quiet_ticks = 0, .seen = true};
      pair.points.push_back(MakePoint(point, side0, side1));
    }
  }
  for (auto& [key, pair] : pairs_) {
    if (pair.seen) {
      std::sort(pair.points.begin(), pair.points.end(), PointLess);
      continue;
    }
    ++pair.quiet_ticks;
    for (ContactPoint& point : pair.points) point.normal_impulse_n_s = 0;
  }
  std::erase_if(pairs_, [](const auto& entry) { return entry.second.quiet_ticks > kHoldTicks; });
}

void BulletContacts::Describe(std::vector<ContactPoint>& contacts) const {
  contacts.clear();
  for (const auto& [key, pair] : pairs_)
    contacts.insert(contacts.end(), pair.points.begin(), pair.points.end());
}

}  // namespace prehend::physics
