// SPDX-License-Identifier: Apache-2.0
// A slider or a hinge of a planar scene in Box2D. Only for physics/box2d. Tested by
// tests/physics/box2d/world_test.cc
#pragma once

#include "physics/box2d/convert.h"
#include "physics/scene/scene.h"

namespace prehend::physics {

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
