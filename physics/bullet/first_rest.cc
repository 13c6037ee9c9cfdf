// SPDX-License-Identifier: Apache-2.0
#include "physics/bullet/first_rest.h"

namespace prehend::physics {

void FirstRest::Watch(double dt_s) {
  if (bodies_.empty() || (ticks_ == 0 && bodies_.size() < kCrowd)) return;
  if (++ticks_ <= kSettling_ticks) return;
  const double share = (kSettling_ticks + kWatched_ticks) * dt_s / gDeactivationTime;
  for (Watched& watched : bodies_) {
    const btRigidBody& body = *watched.body;
    watched.moved |=
        body.getLinearVelocity().length() > share * body.getLinearSleepingThreshold() ||
        body.getAngularVelocity().length() > share * body.getAngularSleepingThreshold();
  }
  if ((ticks_ - kSettling_ticks) % kWatched_ticks != 0) return;
  for (const Watched& watched : bodies_)
    if (!watched.moved) watched.body->setDeactivationTime(gDeactivationTime);
  const bool is_over = ticks_ == kSettling_ticks + kMaxWatches * kWatched_ticks;
  std::erase_if(bodies_, [&](const Watched& watched) {
    const btVector3& p_W_m = watched.body->getWorldTransform().getOrigin();
    return is_over || !watched.moved || p_W_m.distance(watched.p_W_m) > kWhereItBegan_m;
  });
  for (Watched& watched : bodies_) watched.moved = false;
}

}  // namespace prehend::physics
