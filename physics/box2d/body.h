// SPDX-License-Identifier: Apache-2.0
// Bodies of a planar scene as Box2D bodies, made of the sections of their shapes. Only for
// box2d_*.cc. Tested by tests/physics/box2d/world_test.cc
#pragma once

#include <vector>

#include "physics/box2d/convert.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

/// What a contact needs to know about a fixture beyond what Box2D keeps.
struct FixtureFacts {
  ContactSide side;
  double rolling_friction = 0;
};
/// A fixture's user data is its index here.
using FixtureTable = std::vector<FixtureFacts>;

/// What a fixture is made of.
struct Surface {
  double friction = 0;
  double restitution = 0;
  int group = 0;  ///< fixtures of one negative group never touch each other
  FixtureFacts facts;
};

/// Adds the section of a shape that stands at X_PS in the body's frame; has no mass.
void AddSection(const Shape& shape, const Pose& X_PS, const Surface& surface, b2Body& body,
                FixtureTable& table);

/// Bodies that move as one, the root first; what does not depend on a place is the root's.
class Box2dBody {
 public:
  /// `indices`: where the bodies stand in Scene::bodies.
  Box2dBody(const std::vector<const Body*>& bodies, const std::vector<std::size_t>& indices,
            b2World& world, FixtureTable& table);

  b2Body& rigid() { return *rigid_; }
  /// Nothing moves it: it is fixed or asleep.
  bool rests() const { return rigid_->GetType() == b2_staticBody || !rigid_->IsAwake(); }
  /// Of the i-th of the bodies.
  BodyState State(std::size_t i) const;

 private:
  b2Body* rigid_;           ///< the world's
  std::vector<Pose> X_PB_;  ///< the bodies' frames in that of the Box2D body
};

/// Of a thing that stands at X_PB in the body's frame.
BodyState StateOf(const b2Body& body, const Pose& X_PB);

}  // namespace prehend::physics
