// SPDX-License-Identifier: Apache-2.0
// A body of the scene, together with all bodies that fixed joints tie to it, as one Bullet rigid
// body. Bullet requires a frame at the centre of mass with principal axes; our frame B stays where
// the scene put it. Only for physics/bullet. Tested by tests/physics/world/world_test.cc
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <vector>

#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

/// Collision margin of boxes and cylinders, metres. It lies inside the shape, so that outer sizes
/// are exact. Bullet's default of 40 mm is thicker than a finger.
inline constexpr double kMargin_m = 0.001;

/// The shape in the frame of its centre of mass, RigidMember::X_RC.
std::unique_ptr<btCollisionShape> MakeShape(const Shape& shape);

/// Mass, friction, damping and sleeping thresholds of a body with this shape, at the origin.
btRigidBody::btRigidBodyConstructionInfo RigidInfo(const Body& body, btCollisionShape* shape,
                                                   const btVector3& inertia);

class BulletBody {
 public:
  /// `bodies`: the root, then the bodies tied to it. Friction, restitution and damping are the
  /// root's.
  explicit BulletBody(const std::vector<const Body*>& bodies);

  /// From now on the body moves in the plane y = 0 and rotates about y only.
  void KeepInPlane();

  btRigidBody& rigid() { return *rigid_; }
  /// It is fixed or asleep.
  bool rests() const {
    return !rigid_->isKinematicObject() && (rigid_->isStaticObject() || !rigid_->isActive());
  }
  /// State of the i-th body.
  BodyState State(std::size_t i) const;
  /// For each shape of the rigid body, the index of the body that it belongs to.
  const std::vector<std::size_t>& owners() const { return owners_; }

 private:
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::unique_ptr<btRigidBody> rigid_;
  std::vector<std::size_t> owners_;
  std::vector<Pose> X_CB_;  ///< the bodies' frames B in Bullet's centre-of-mass frame
};

}  // namespace prehend::physics
