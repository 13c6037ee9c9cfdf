// SPDX-License-Identifier: Apache-2.0
// Where a person looks: what she wants to see, and how eyes and head get there. Left alone, her
// eyes lead her hands: they go to a thing when a hand starts for it, and to the place where it will
// be put down when it is carried (Johansson, Westling, Bäckström & Flanagan 2001). Tested by
// tests/physics/person/gaze_test.cc
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "physics/motion/script.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"
#include "physics/world/world.h"

namespace prehend::physics {

/// What is looked at: a body or a hand of the scene, a point of the world, or whatever is ahead.
struct GazeTarget {
  enum class Kind { kAhead, kBody, kHand, kPoint };
  Kind kind = Kind::kAhead;
  int index = 0;  ///< of the body or hand
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
};

/// The middle of what is looked at; nothing for what is ahead.
std::optional<Eigen::Vector3d> PointOf(const GazeTarget& target, const Scene& scene,
                                       const Snapshot& now);

/// The first gaze target of the scene that the ball of her sight meets before what she sees. Gaze
/// targets are no matter, so that no engine meets them.
struct TargetSeen {
  int body = -1;
  double distance_m = 0;
};
std::optional<TargetSeen> TargetInSight(const Scene& scene, const GazeState& gaze,
                                        const SightLine& line = {});

/// Chooses for a person whose eyes lead her hands.
class GazeLeader {
 public:
  /// `script` and `scene` must outlive it.
  GazeLeader(const Scene& scene, const Script& script, const Person& person);

  /// Where to look from the begin of this beat of the script on.
  void Begin(std::size_t beat, const Snapshot& now);
  const GazeTarget& target() const { return target_; }

 private:
  std::optional<GazeTarget> TargetOf(const Step& step, std::size_t beat, const Snapshot& now);
  std::optional<Eigen::Vector3d> LandingPlace(const CarryStep& carry, int hand, std::size_t beat,
                                              const Snapshot& now) const;

  const Scene& scene_;
  const Script& script_;
  const Person& person_;
  std::vector<int> reached_;  ///< per hand of the scene: the body it reached for last; -1: none
  GazeTarget target_;
};

/// Moves eyes and head. Eyes jump to a new target: a saccade of 21 ms and 2.2 ms per degree
/// (Carpenter 1988); a target that moves is followed. The head comes after.
class EyesAndHead {
 public:
  explicit EyesAndHead(const Eigen::Vector3d& ahead_W)
      : eyes_W_(ahead_W), head_W_(ahead_W), from_W_(ahead_W) {}

  /// One tick towards this direction.
  void Turn(const Eigen::Vector3d& wanted_W, double dt_s);
  /// At once.
  void Set(const Eigen::Vector3d& toward_W);

  const Eigen::Vector3d& eyes_W() const { return eyes_W_; }
  const Eigen::Vector3d& head_W() const { return head_W_; }

 private:
  Eigen::Vector3d eyes_W_, head_W_;
  Eigen::Vector3d from_W_;  ///< where the saccade began
  double saccade_s_ = 0;    ///< its duration; 0: none
  double since_s_ = 0;
};

}  // namespace prehend::physics
