// SPDX-License-Identifier: Apache-2.0
// A body of the scene, together with all bodies that fixed joints tie to it, as one Bullet rigid
// body. Bullet requires a frame at the centre of mass with principal axes; our frame B stays where
// the scene put it. Only for physics/bullet. Tested by tests/physics/world/world_test.cc
#pragma once

#include <LinearMath/btTransform.h>
#include <btBulletDynamicsCommon.h>

#include <memory>
#include <vector>

#include "physics/base/pose.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"
#include "physics/world/joint_spring.h"

namespace prehend::physics {

// Conversions between our vectors and Bullet's. Only for physics/bullet. Tested by
// tests/physics/world/world_test.cc

static_assert(sizeof(btScalar) == 8,
              "the float build of Bullet was found: use pkg-config bullet-float64");

inline btVector3 ToBullet(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
inline btQuaternion ToBullet(const Eigen::Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }
inline btTransform ToBullet(const Pose& pose) {
  return btTransform(ToBullet(pose.q), ToBullet(pose.p_m));
}

inline Eigen::Vector3d FromBullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
inline Eigen::Quaterniond FromBullet(const btQuaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }
inline Pose FromBullet(const btTransform& X) {
  return {FromBullet(X.getOrigin()), FromBullet(X.getRotation())};
}

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

// A joint between two bodies in Bullet: one constraint with six axes, some of which are free. Only
// for physics/bullet. Tested by tests/physics/scene/joint_test.cc

class BulletJoint {
 public:
  /// A slider, hinge or ball joint; a fixed joint needs no constraint, because its bodies are one
  /// (BulletBody). The bodies must still be at their initial poses. `sharers`: see SpringForce.
  BulletJoint(const Joint& joint, int sharers, btRigidBody& base, btRigidBody& body);

  /// Computes spring, damping and the distance to the limits for the coming tick. Friction and
  /// limits are rows of the constraint. Nothing moves yet, so that joints that share a body all
  /// read the state after the last tick.
  void Prepare(double dt_s);
  /// Applies spring and damping; call after all joints are loaded.
  void Pull();
  btTypedConstraint& constraint() { return *constraint_; }

 private:
  JointPlace Place(double position) const;

  Joint joint_;
  int sharers_;
  double impulse_ = 0;  ///< of spring and damping in the coming tick: N s or N m s
  std::unique_ptr<btGeneric6DofSpring2Constraint> constraint_;
};

}  // namespace prehend::physics
