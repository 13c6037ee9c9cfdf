// SPDX-License-Identifier: Apache-2.0
// The border to a physics engine: a world takes hand commands, steps, and tells its state as a
// Snapshot. One world per run, never reset. Implementations: physics/bullet/world.h and, for planar
// scenes, physics/box2d/world.h. Tested by tests/physics/world/world_test.cc
#pragma once

#include <vector>

#include "physics/motion/trajectory.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

/// What one hand is told for one tick.
struct HandCommand {
  TargetState target;
  int style = 0;  ///< index into HandModel::styles
};

/// The way of a ball.
struct SightLine {
  Eigen::Vector3d from_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d toward_W = Eigen::Vector3d::UnitX();  ///< unit
  double radius_m = 0.015;
  double length_m = 10;
  int ignore_from = 0, ignore_to = 0;  ///< these bodies are not met: [from, to)
};
struct Sight {
  int body = -1;
  int hand = -1;
  double distance_m = 0;
};

class World {
 public:
  virtual ~World() = default;

  /// Advances one tick; one command per hand of the scene.
  virtual void Step(const std::vector<HandCommand>& commands) = 0;
  /// Writes the present state, reusing the vectors of `snapshot`.
  virtual void Describe(Snapshot& snapshot) const = 0;

  /// During the next step the kinematic body goes there. Only for scenes with persons.
  virtual void MoveKinematic(int body, const Pose& X_WB);
  /// The first thing that a ball meets on a straight way. Only for scenes with persons.
  virtual Sight Look(const SightLine& line) const;
};

}  // namespace prehend::physics
