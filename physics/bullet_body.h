// SPDX-License-Identifier: Apache-2.0
// A body of the scene as a Bullet rigid body. Bullet wants the frame at the centre of mass with
// principal axes; our frame B stays where the scene put it. Only for bullet_*.cc.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <vector>

#include "physics/scene.h"
#include "physics/snapshot.h"

namespace prehend::physics {

/// Collision margin of boxes and cylinders, metres: inside the shape, so that sizes stay true. The
/// default of 40 mm would swallow fingers.
inline constexpr double kMargin_m = 0.001;

std::unique_ptr<btCollisionShape> MakeShape(const Shape& shape);

class BulletBody {
 public:
  explicit BulletBody(const Body& body);

  btRigidBody& rigid() { return *rigid_; }
  BodyState State() const;

 private:
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::unique_ptr<btRigidBody> rigid_;
  Pose X_CB_;  ///< frame B in Bullet's centre-of-mass frame
};

}  // namespace prehend::physics
