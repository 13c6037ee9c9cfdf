// SPDX-License-Identifier: Apache-2.0
// A body of the scene, with all bodies that fixed joints tie to it, as one Bullet rigid body.
// Bullet wants the frame at the centre of mass with principal axes; our frame B stays where the
// scene put it. Only for bullet_*.cc.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <vector>

#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

/// Collision margin of boxes and cylinders, metres: inside the shape, so that sizes stay true. The
/// default of 40 mm would swallow fingers.
inline constexpr double kMargin_m = 0.001;

/// In the frame of its centre of mass: RigidMember::X_RC.
std::unique_ptr<btCollisionShape> MakeShape(const Shape& shape);

/// Mass, surface, damping and sleep of a body that has this shape, at the origin.
btRigidBody::btRigidBodyConstructionInfo RigidInfo(const Body& body, btCollisionShape* shape,
                                                   const btVector3& inertia);

class BulletBody {
 public:
  /// `bodies`: the root, then those tied to it. Friction, restitution and damping are the root's.
  explicit BulletBody(const std::vector<const Body*>& bodies);

  /// From now on it moves in the plane y = 0 and turns about y only.
  void KeepInPlane();

  btRigidBody& rigid() { return *rigid_; }
  /// Nothing moves it: it is fixed or asleep.
  bool rests() const {
    return !rigid_->isKinematicObject() && (rigid_->isStaticObject() || !rigid_->isActive());
  }
  /// Of the i-th of the bodies.
  BodyState State(std::size_t i) const;
  /// Which of the bodies each of the rigid body's shapes belongs to.
  const std::vector<std::size_t>& owners() const { return owners_; }

 private:
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::unique_ptr<btRigidBody> rigid_;
  std::vector<std::size_t> owners_;
  std::vector<Pose> X_CB_;  ///< the bodies' frames B in Bullet's centre-of-mass frame
};

}  // namespace prehend::physics
