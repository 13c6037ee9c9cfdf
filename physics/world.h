// SPDX-License-Identifier: Apache-2.0
// The border to a physics engine: a world takes hand commands, steps, and tells its state as a
// Snapshot. One world per run, never reset. Implementations: physics/bullet_world.h and, for planar
// scenes, physics/box2d_world.h. Tested by tests/physics/world_test.cc
#pragma once

#include <vector>

#include "physics/snapshot.h"
#include "physics/trajectory.h"

namespace prehend::physics {

/// What one hand is told for one tick.
struct HandCommand {
  TargetState target;
  int style = 0;  ///< index into HandModel::styles
};

class World {
 public:
  virtual ~World() = default;

  /// Advances one tick; one command per hand of the scene.
  virtual void Step(const std::vector<HandCommand>& commands) = 0;
  /// Writes the present state, reusing the vectors of `snapshot`.
  virtual void Describe(Snapshot& snapshot) const = 0;
};

}  // namespace prehend::physics
