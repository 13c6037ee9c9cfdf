// SPDX-License-Identifier: Apache-2.0
// The interface to a physics engine: a world takes hand commands, steps, and writes its state into
// a Snapshot. One world per run, never reset. Implementations: physics/bullet/world.h and, for
// planar scenes, physics/box2d/world.h. Tested by tests/physics/world/world_test.cc
#pragma once

#include <optional>
#include <vector>

#include "physics/motion/trajectory.h"
#include "physics/scene/snapshot.h"

namespace prehend::physics {

/// Command to one hand for one tick.
struct HandCommand {
  TargetState target;
  int style = 0;  ///< index into HandModel::styles
  /// It lets go of what stands, its arm is to push no longer: the trigger to which it opens.
  std::optional<double> lets_go_to = std::nullopt;
};

/// A line of sight: the path of a sphere.
struct SightLine {
  Eigen::Vector3d from_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d toward_W = Eigen::Vector3d::UnitX();  ///< unit
  double radius_m = 0.015;
  double length_m = 10;
  /// Bodies that are transparent: [from, to).
  BodyIndex ignore_from = BodyIndex(0), ignore_to = BodyIndex(0);
};
struct Sight {
  BodyIndex body = {};
  HandIndex hand = {};
  double distance_m = 0;
};

class World {
 public:
  virtual ~World() = default;

  /// Advances one tick; one command per hand of the scene.
  virtual void Step(const std::vector<HandCommand>& commands) = 0;
  /// Writes the present state, reusing the vectors of `snapshot`.
  virtual void Describe(Snapshot& snapshot) const = 0;

  /// Moves a kinematic body there during the next step, or, if it jumps, puts it there at rest.
  /// Only for scenes with persons.
  virtual void MoveKinematic(BodyIndex body, const Pose& X_WB, bool jumps);
  /// The first surface that the sphere meets. Only for scenes with persons.
  virtual Sight Look(const SightLine& line) const;
};

}  // namespace prehend::physics
