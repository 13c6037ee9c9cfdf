// SPDX-License-Identifier: Apache-2.0
// A hand in the plane: palm and links are Box2D bodies on driven joints, and the palm follows its
// target with the same limited PIDs as in Bullet. It holds objects by friction only; nothing ever
// ties an object to it. Only for physics/box2d. Tested by tests/physics/box2d/world_test.cc
#pragma once

#include <vector>

#include "physics/box2d/body.h"
#include "physics/hand/grip.h"
#include "physics/hand/pid.h"
#include "physics/world/world.h"

namespace prehend::physics {

class Box2dHand {
 public:
  /// The hand starts open in `style`.
  Box2dHand(const Hand& hand, HandIndex index, int style, b2World& world, FixtureTable& table);

  /// Sets forces and motor speeds for the coming tick.
  void Drive(const HandCommand& command, double dt_s);
  void Describe(HandState& state) const;

 private:
  struct Part {
    b2Body* body;  ///< the world's
    Pose X_PL;     ///< the part's own frame in that of the Box2D body
  };
  struct Motor {
    double sign;   ///< Box2D's coordinate times this is ours
    double start;  ///< our coordinate at Box2D's 0
    b2PrismaticJoint* slide = nullptr;
    b2RevoluteJoint* hinge = nullptr;
  };

  Part MakePart(LinkIndex link, const Pose& X_WL, const Eigen::Vector3d& size_m, double mass_kg,
                double inertia_scale, b2World& world, FixtureTable& table);
  Motor MakeMotor(const HandLink& link, const Eigen::Vector3d& axis_W,
                  const Eigen::Vector3d& pivot_W_m, double start, b2Body& parent, b2Body& body);
  double Joint(const Motor& motor) const;
  void Drive(const Motor& motor, double wanted_speed, double damping, double strength);

  HandModel model_;
  HandIndex index_ = {};
  PalmPids pids_;
  Grip grip_;
  HandCommand command_;
  Part palm_;
  std::vector<Part> links_;
  std::vector<Motor> motors_;  ///< one per link
};

}  // namespace prehend::physics
