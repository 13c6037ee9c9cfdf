// SPDX-License-Identifier: Apache-2.0
// The grains of one body: many Bullet spheres that share one shape. Only for physics/bullet. Tested
// by tests/physics/world/grains_test.cc
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <span>
#include <vector>

#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

class BulletGrains {
 public:
  /// Requires a body with grains.
  explicit BulletGrains(const Body& body);

  std::span<const std::unique_ptr<btRigidBody>> rigids() const { return rigids_; }

  /// Stops grains that left the world, so that spilt grains do not fall for ever.
  void StopLost();

  /// Whether all grains are asleep.
  bool rests() const;
  /// Mean position and velocity.
  BodyState Mean() const;
  void AppendCentres(std::vector<Eigen::Vector3d>& centres_W_m) const;

 private:
  btSphereShape shape_;
  std::vector<std::unique_ptr<btRigidBody>> rigids_;
};

}  // namespace prehend::physics
