// SPDX-License-Identifier: Apache-2.0
// The grains of one body: as many Bullet balls, which share a shape. Only for bullet_*.cc. Tested
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
  /// `body` has grains.
  explicit BulletGrains(const Body& body);

  std::span<const std::unique_ptr<btRigidBody>> rigids() const { return rigids_; }

  /// Stops those that left the world, so that what is spilt does not fall for ever.
  void StopLost();

  /// Are all asleep?
  bool rests() const;
  /// Place and velocity, the mean of all.
  BodyState Mean() const;
  void AppendCentres(std::vector<Eigen::Vector3d>& centres_W_m) const;

 private:
  btSphereShape shape_;
  std::vector<std::unique_ptr<btRigidBody>> rigids_;
};

}  // namespace prehend::physics
