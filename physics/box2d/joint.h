// SPDX-License-Identifier: Apache-2.0
// A slider or a hinge of a planar scene in Box2D. Only for box2d_*.cc. Tested by
// tests/physics/box2d/world_test.cc
#pragma once

#include "physics/box2d/convert.h"
#include "physics/scene/scene.h"

namespace prehend::physics {

class Box2dJoint {
 public:
  /// A ball joint is a hinge without limits here. `sharers`: see SpringForce. The two sides never
  /// touch each other.
  Box2dJoint(const Joint& joint, int sharers, b2Body& base, b2Body& body, b2World& world);

  /// Spring and damping of the coming tick; friction and limits are Box2D's own.
  void Pull(double dt_s);

 private:
  Joint joint_;
  int sharers_;
  double sign_;                         ///< of Box2D's coordinate against ours
  b2PrismaticJoint* slider_ = nullptr;  ///< the world's; one of the two
  b2RevoluteJoint* hinge_ = nullptr;
};

}  // namespace prehend::physics
