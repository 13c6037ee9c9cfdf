// SPDX-License-Identifier: Apache-2.0
// Grains have their own sleeping thresholds. Tested by tests/physics/world/grains_test.cc
#include "physics/bullet/grains.h"

#include <algorithm>

#include "physics/bullet/body.h"

namespace prehend::physics {
namespace {

/// A grain farther from the origin than this has left the scene.
constexpr double kLost_m = 10;
/// Sleeping speed of a grain, and of a point of its surface.
constexpr double kGrainSleepSpeed_m_per_s = 0.05;

}  // namespace

BulletGrains::BulletGrains(const Body& body) : shape_(body.grains->radius_m) {
  const auto count = static_cast<double>(body.grains->p_WG_m.size());
  Body grain = body;
  grain.grains.reset();
  grain.mass_kg = body.mass_kg / count;
  btVector3 inertia;
  shape_.calculateLocalInertia(grain.mass_kg, inertia);
  btRigidBody::btRigidBodyConstructionInfo info = RigidInfo(grain, &shape_, inertia);
  // Grains in a heap tremble, and they rotate fast for their size: with the thresholds of other
  // bodies no heap would ever sleep.
  info.m_linearSleepingThreshold = kGrainSleepSpeed_m_per_s;
  info.m_angularSleepingThreshold = kGrainSleepSpeed_m_per_s / body.grains->radius_m;
  for (const Eigen::Vector3d& p_WG_m : body.grains->p_WG_m) {
    info.m_startWorldTransform.setOrigin(ToBullet(p_WG_m));
    rigids_.push_back(std::make_unique<btRigidBody>(info));
  }
}

void BulletGrains::StopLost() {
  for (const auto& rigid : rigids_) {
    const bool lost =
        rigid->isActive() && rigid->getWorldTransform().getOrigin().length() > kLost_m;
    if (!lost) continue;
    rigid->setLinearVelocity({0, 0, 0});
    rigid->setAngularVelocity({0, 0, 0});
    rigid->forceActivationState(DISABLE_SIMULATION);
  }
}

bool BulletGrains::rests() const {
  return std::none_of(rigids_.begin(), rigids_.end(),
                      [](const auto& rigid) { return rigid->isActive(); });
}

BodyState BulletGrains::Mean() const {
  BodyState mean{.asleep = rests()};
  const auto count = static_cast<double>(rigids_.size());
  for (const auto& rigid : rigids_) {
    mean.X_WB.p_m += FromBullet(rigid->getWorldTransform().getOrigin()) / count;
    mean.v_WB_m_per_s += FromBullet(rigid->getLinearVelocity()) / count;
  }
  return mean;
}

void BulletGrains::AppendCentres(std::vector<Eigen::Vector3d>& centres_W_m) const {
  for (const auto& rigid : rigids_)
    centres_W_m.push_back(FromBullet(rigid->getWorldTransform().getOrigin()));
}

}  // namespace prehend::physics
