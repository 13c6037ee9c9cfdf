// SPDX-License-Identifier: Apache-2.0
// Between our vectors and Box2D's: its x is the world's x, its y the world's z. Box2D's tolerances
// are made for things of metres, ours have centimetres: lengths, speeds and forces are ten times
// larger inside, torques and moments of inertia a hundred times. Angles there turn from x towards
// z, which is about -y. Only for box2d_*.cc.
#pragma once

#include <box2d/box2d.h>

#include <algorithm>

#include "physics/scene/pose.h"

namespace prehend::physics {

inline constexpr double kLengthScale = 10;
inline constexpr double kTorqueScale = kLengthScale * kLengthScale;

/// Box2D rests things this deep in each other, 0.5 mm for us. Every section is larger by half of
/// it, so that things rest where they should.
inline constexpr float kSink = b2_linearSlop;

/// Of a point, a velocity or a force.
inline b2Vec2 ToBox2d(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x() * kLengthScale), static_cast<float>(v.z() * kLengthScale)};
}
/// Of a direction.
inline b2Vec2 DirectionToBox2d(const Eigen::Vector3d& unit) {
  return {static_cast<float>(unit.x()), static_cast<float>(unit.z())};
}

inline Eigen::Vector3d FromBox2d(const b2Vec2& v) {
  return {v.x / kLengthScale, 0, v.y / kLengthScale};
}

/// The limits of a joint in Box2D's coordinate: `scale` times ours, the other way round when it is
/// negative.
inline void SetLimits(double lower, double upper, double scale, float& least, float& most) {
  least = static_cast<float>(std::min(scale * lower, scale * upper));
  most = static_cast<float>(std::max(scale * lower, scale * upper));
}

/// In Box2D's units; its own GetInertia() is about the body's origin.
inline float MomentAboutCentre(const b2Body& body) {
  return body.GetInertia() - body.GetMass() * body.GetLocalCenter().LengthSquared();
}

/// The frame P of a Box2D body: it starts with the world's axes, whatever stands in it.
inline Pose PoseOf(const b2Body& body) {
  return {FromBox2d(body.GetPosition()),
          Eigen::Quaterniond(Eigen::AngleAxisd(body.GetAngle(), -Eigen::Vector3d::UnitY()))};
}

}  // namespace prehend::physics
