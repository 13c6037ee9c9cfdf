// SPDX-License-Identifier: Apache-2.0
// Conversions between our vectors and Bullet's. Only for physics/bullet. Tested by
// tests/physics/world/world_test.cc
#pragma once

#include <LinearMath/btTransform.h>

#include "physics/base/pose.h"

namespace prehend::physics {

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

}  // namespace prehend::physics
