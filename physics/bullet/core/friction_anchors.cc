// SPDX-License-Identifier: Apache-2.0
// Contacts are found anew in every tick. One is the same as before if it is near to where it was.
// Tested by tests/physics/world/holding_test.cc and tests/physics/world/resting_test.cc
#include "physics/bullet/core/friction_anchors.h"

#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

namespace prehend::physics {
namespace {

/// Contact points of one face are farther from each other than this, and none moves so far in a
/// tick without sliding.
constexpr btScalar kSamePoint_m = 0.003;

/// Way that a contact remembers when it slips: as much as takes back 5 mm/s at 480 ticks per
/// second.
constexpr btScalar kRemembered_m = 5e-5;

/// Of a small rotation.
btVector3 VectorOf(const btMatrix3x3& R) {
  return btVector3(R[2][1] - R[1][2], R[0][2] - R[2][0], R[1][0] - R[0][1]) / 2;
}

}  // namespace

btTransform FrictionAnchors::Side::Place() const {
  if (multibody)
    return (link < 0 ? multibody->getBaseCollider() : multibody->getLink(link).m_collider)
        ->getWorldTransform();
  return rigid ? rigid->getWorldTransform() : btTransform::getIdentity();
}

void FrictionAnchors::BeginTick() {
  before_.clear();
  for (const Anchor& anchor : present_)
    if (anchor.sticks) before_.push_back(anchor);
  present_.clear();
  next_ = 0;
}

FrictionAnchors::Drift FrictionAnchors::Add(const btManifoldPoint& point, const Sides& sides) {
  const btVector3 &p = point.getPositionWorldOnA(), &n = point.m_normalWorldOnB;
  Anchor now{.sides = sides, .p_A = {}, .turn_A = {0, 0, 0}, .sticks = true, .slid = false};
  const btTransform X_WA = sides.first.Place(), X_WB = sides.second.Place();
  const btMatrix3x3& R_WA = X_WA.getBasis();
  now.p_A = X_WA.invXform(p);
  now.R_AB = R_WA.transposeTimes(X_WB.getBasis());
  now.nhat_A = n * R_WA;
  const Anchor* same = nullptr;
  btScalar nearest = kSamePoint_m * kSamePoint_m;
  // Those of two bodies are neighbours, and the next ones are where they were in the last tick.
  std::optional<std::size_t> first;
  for (std::size_t k = 0; k < before_.size(); ++k) {
    const std::size_t place = (next_ + k) % before_.size();
    const Anchor& old = before_[place];
    if (old.sides != sides) {
      if (first) break;
      continue;
    }
    if (!first) first = place;
    const btScalar distance = (old.p_A - now.p_A).length2();
    if (distance >= nearest) continue;
    nearest = distance;
    same = &old;
  }
  if (first) next_ = *first;
  Drift drift;
  if (same) {
    drift.way = X_WA * same->p_A - X_WB * same->p_B;
    drift.way -= n * n.dot(drift.way);
    const btScalar length = drift.way.length();
    if (same->slid && length > kRemembered_m) drift.way *= kRemembered_m / length;
    now.turn_A = same->turn_A - VectorOf(now.R_AB.timesTranspose(same->R_AB));
    drift.turn = R_WA * now.turn_A;
  }
  now.p_B = X_WB.invXform(p - drift.way);
  present_.push_back(now);
  return drift;
}

void FrictionAnchors::ForgetSpin(std::size_t contact) {
  Anchor& anchor = present_[contact];
  anchor.turn_A -= anchor.nhat_A * anchor.nhat_A.dot(anchor.turn_A);
}

void FrictionAnchors::ForgetRoll(std::size_t contact) {
  Anchor& anchor = present_[contact];
  anchor.turn_A = anchor.nhat_A * anchor.nhat_A.dot(anchor.turn_A);
}

}  // namespace prehend::physics
