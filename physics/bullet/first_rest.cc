// SPDX-License-Identifier: Apache-2.0
// Tested by tests/physics/world/first_rest_test.cc
#include "physics/bullet/first_rest.h"

namespace prehend::physics {

void FirstRest::Watch(double dt_s) {
  if (bodies_.size() < kCrowd) return;
  time_s_ += dt_s;
  const double share = kWatched_s / gDeactivationTime;
  for (Watched& watched : bodies_) {
    const btRigidBody& body = *watched.body;
    watched.moved |=
        body.getLinearVelocity().length() > share * body.getLinearSleepingThreshold() ||
        body.getAngularVelocity().length() > share * body.getAngularSleepingThreshold();
  }
  if (time_s_ < kWatched_s) return;
  for (const Watched& watched : bodies_)
    if (!watched.moved) watched.body->setDeactivationTime(gDeactivationTime);
  bodies_.clear();
}

}  // namespace prehend::physics
