// SPDX-License-Identifier: Apache-2.0
// Bodies of a planar scene as Box2D bodies, made of the cross-sections of their shapes. Only for
// physics/box2d. Tested by tests/physics/box2d/world_test.cc
#pragma once

#include <vector>

#include "physics/box2d/convert.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

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

}  // namespace prehend::physics
