// SPDX-License-Identifier: Apache-2.0
// Conversions between our vectors and Box2D's: its x is the world's x, its y is the world's z.
// Box2D's tolerances are made for objects of metres, and ours measure centimetres: inside Box2D,
// lengths, speeds and forces are ten times larger, torques and moments of inertia a hundred times.
// Angles in Box2D turn from x towards z, which is a rotation about -y. Only for physics/box2d.
// Tested by tests/physics/box2d/world_test.cc
#pragma once

#include <box2d/box2d.h>

#include <algorithm>

#include "physics/base/pose.h"

namespace prehend::physics {

inline constexpr double kLengthScale = 10;
inline constexpr double kTorqueScale = kLengthScale * kLengthScale;

/// In Box2D resting bodies overlap by this much, 0.5 mm in our units. Every cross-section is larger
/// by half of it, so that bodies rest at their true height.
inline constexpr float kSink = b2_linearSlop;

/// Converts a point, a velocity or a force.
inline b2Vec2 ToBox2d(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x() * kLengthScale), static_cast<float>(v.z() * kLengthScale)};
}
/// Converts a direction, without scaling.
inline b2Vec2 DirectionToBox2d(const Eigen::Vector3d& unit) {
  return {static_cast<float>(unit.x()), static_cast<float>(unit.z())};
}

inline Eigen::Vector3d FromBox2d(const b2Vec2& v) {
  return {v.x / kLengthScale, 0, v.y / kLengthScale};
}

/// The limits of a joint in Box2D's coordinate: ours times `scale`; a negative scale swaps them.
inline void SetLimits(double lower, double upper, double scale, float& least, float& most) {
  least = static_cast<float>(std::min(scale * lower, scale * upper));
  most = static_cast<float>(std::max(scale * lower, scale * upper));
}

/// Moment of inertia about the centre of mass, in Box2D's units; Box2D's GetInertia() is about the
/// body's origin.
inline float MomentAboutCentre(const b2Body& body) {
  return body.GetInertia() - body.GetMass() * body.GetLocalCenter().LengthSquared();
}

/// The frame P of a Box2D body: its axes are the world's at the start, whatever bodies it holds.
inline Pose PoseOf(const b2Body& body) {
  return {FromBox2d(body.GetPosition()),
          Eigen::Quaterniond(Eigen::AngleAxisd(body.GetAngle(), -Eigen::Vector3d::UnitY()))};
}

}  // namespace prehend::physics
