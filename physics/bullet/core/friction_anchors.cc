// SPDX-License-Identifier: Apache-2.0
// Contacts are found anew in every tick. One is the same as before if it is near to where it was.
// Tested by tests/physics/world/holding_test.cc
#include "physics/bullet/core/friction_anchors.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

namespace prehend::physics {
namespace {

/// Contact points of one face are farther from each other than this, and none moves so far in a
/// tick without sliding.
constexpr btScalar kSamePoint_m = 0.003;

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
}

FrictionAnchors::Drift FrictionAnchors::Add(const btMultiBodySolverConstraint& row,
                                            const btRigidBody* a, const btRigidBody* b) {
  const auto& point = *static_cast<const btManifoldPoint*>(row.m_originalContactPoint);
  const btVector3 &p = point.getPositionWorldOnA(), &n = point.m_normalWorldOnB;
  Anchor now{.a = {row.m_multiBodyA, row.m_multiBodyA ? row.m_linkA : 0, a},
             .b = {row.m_multiBodyB, row.m_multiBodyB ? row.m_linkB : 0, b},
             .p_A = {},
             .turn_A = {0, 0, 0},
             .sticks = true};
  const btTransform X_WA = now.a.Place(), X_WB = now.b.Place();
  const btMatrix3x3& R_WA = X_WA.getBasis();
  now.p_A = X_WA.invXform(p);
  now.R_AB = R_WA.transposeTimes(X_WB.getBasis());
  now.nhat_A = n * R_WA;
  const Anchor* same = nullptr;
  btScalar nearest = kSamePoint_m * kSamePoint_m;
  for (const Anchor& old : before_) {
    const btScalar distance = (old.p_A - now.p_A).length2();
    if (distance >= nearest || old.a != now.a || old.b != now.b) continue;
    nearest = distance;
    same = &old;
  }
  Drift drift;
  if (same) {
    drift.way = X_WA * same->p_A - X_WB * same->p_B;
    drift.way -= n * n.dot(drift.way);
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
