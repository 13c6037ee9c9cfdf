// SPDX-License-Identifier: Apache-2.0
// Bodies of a planar scene as Box2D bodies, made of the cross-sections of their shapes. Only for
// physics/box2d. Tested by tests/physics/box2d/world_test.cc
#pragma once

#include <box2d/box2d.h>

#include <algorithm>
#include <vector>

#include "physics/base/pose.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

// Conversions between our vectors and Box2D's: its x is the world's x, its y is the world's z.
// Box2D's tolerances are made for objects of metres, and ours measure centimetres: inside Box2D,
// lengths, speeds and forces are ten times larger, torques and moments of inertia a hundred times.
// Angles in Box2D turn from x towards z, which is a rotation about -y. Only for physics/box2d.
// Tested by tests/physics/box2d/world_test.cc

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

/// Facts about a fixture that contacts need and Box2D does not keep.
struct FixtureFacts {
  ContactSide side;
  double rolling_friction = 0;
};
/// A fixture's user data is its index here.
using FixtureTable = std::vector<FixtureFacts>;

/// Material and collision group of a fixture.
struct Surface {
  double friction = 0;
  double restitution = 0;
  int group = 0;  ///< fixtures of one negative group never touch each other
  FixtureFacts facts;
};

/// Adds the cross-section of a shape at X_PS in the body's frame, without mass.
void AddSection(const Shape& shape, const Pose& X_PS, const Surface& surface, b2Body& body,
                FixtureTable& table);

/// Bodies that move as one rigid body, the root first; friction, restitution and damping are the
/// root's.
class Box2dBody {
 public:
  /// `indices`: the bodies' indices into Scene::bodies.
  Box2dBody(const std::vector<const Body*>& bodies, const std::vector<std::size_t>& indices,
            b2World& world, FixtureTable& table);

  b2Body& rigid() { return *rigid_; }
  /// It is fixed or asleep.
  bool rests() const { return rigid_->GetType() == b2_staticBody || !rigid_->IsAwake(); }
  /// State of the i-th body.
  BodyState State(std::size_t i) const;

 private:
  b2Body* rigid_;           ///< the world's
  std::vector<Pose> X_PB_;  ///< the bodies' frames in that of the Box2D body
};

/// State of a scene body whose frame is at X_PB in the frame of the Box2D body.
BodyState StateOf(const b2Body& body, const Pose& X_PB);

// A slider or a hinge of a planar scene in Box2D. Only for physics/box2d. Tested by
// tests/physics/box2d/world_test.cc

class Box2dJoint {
 public:
  /// In the plane a ball joint is a hinge without limits. `sharers`: see SpringForce. The two sides
  /// do not collide.
  Box2dJoint(const Joint& joint, int sharers, b2Body& base, b2Body& body, b2World& world);

  /// Applies spring and damping for the coming tick; friction and limits are Box2D's own.
  void Pull(double dt_s);

 private:
  Joint joint_;
  int sharers_;
  double sign_;                         ///< Box2D's coordinate times this is ours
  b2PrismaticJoint* slider_ = nullptr;  ///< owned by the world; one of the two is set
  b2RevoluteJoint* hinge_ = nullptr;
};

}  // namespace prehend::physics
