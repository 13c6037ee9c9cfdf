// SPDX-License-Identifier: Apache-2.0
// Where a person looks: which target she chooses, and how eyes and head move to it. Without
// instructions her eyes lead her hands: they go to an object when a hand starts to move to it, and
// to the landing place when it is carried (Johansson, Westling, Bäckström & Flanagan 2001). Tested
// by tests/physics/person/gaze_test.cc
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "physics/motion/script.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"
#include "physics/world/world.h"

namespace prehend::physics {

/// A gaze target: a body or a hand of the scene, a point of the world, or straight ahead.
struct GazeTarget {
  enum class Kind { kAhead, kBody, kHand, kPoint };
  Kind kind = Kind::kAhead;
  BodyIndex body = {};  ///< of kBody
  HandIndex hand = {};  ///< of kHand
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
};

/// The centre of a target; nullopt for straight ahead.
std::optional<Eigen::Vector3d> PointOf(const GazeTarget& target, const Scene& scene,
                                       const Snapshot& now);

/// The nearest gaze target of the scene along her line of sight, if it is nearer than what she
/// sees. No engine finds gaze targets, because they are abstract.
struct TargetSeen {
  BodyIndex body = {};
  double distance_m = 0;
};
std::optional<TargetSeen> TargetInSight(const Scene& scene, const GazeState& gaze,
                                        const SightLine& line = {});

/// Chooses targets for a person whose eyes lead her hands.
class GazeLeader {
 public:
  /// `script` and `scene` must outlive it.
  GazeLeader(const Scene& scene, const Script& script, const Person& person);

  /// Chooses the target from the beginning of these steps of hands on.
  void Begin(std::size_t stage, const std::vector<std::size_t>& steps, const Snapshot& now);
  const GazeTarget& target() const { return target_; }

 private:
  std::optional<GazeTarget> TargetOf(std::size_t stage, std::size_t index, const Snapshot& now);
  std::optional<Eigen::Vector3d> LandingPlace(const CarryStep& carry, std::size_t stage,
                                              std::size_t index, const Snapshot& now) const;

  const Scene& scene_;
  const Script& script_;
  const Person& person_;
  std::vector<BodyIndex> reached_;  ///< by hand: the body last reached for, or none
  GazeTarget target_;
};

/// Moves eyes and head. Eyes jump to a new target in a saccade of 21 ms plus 2.2 ms per degree
/// (Carpenter 1988) and follow a moving target. The head follows more slowly. To what is behind
/// they turn to the side, not over the vertical.
class EyesAndHead {
 public:
  explicit EyesAndHead(const Eigen::Vector3d& ahead_W)
      : eyes_W_(ahead_W), head_W_(ahead_W), from_W_(ahead_W) {}

  /// Turns towards this direction for one tick.
  void Turn(const Eigen::Vector3d& wanted_W, double dt_s);
  /// Turns eyes and head at once.
  void Set(const Eigen::Vector3d& toward_W);

  const Eigen::Vector3d& eyes_W() const { return eyes_W_; }
  const Eigen::Vector3d& head_W() const { return head_W_; }

 private:
  void TurnHead(double dt_s);

  Eigen::Vector3d eyes_W_, head_W_;
  Eigen::Vector3d from_W_;  ///< where the saccade began
  double yaw_ = 0;          ///< its way round the vertical, radians
  double saccade_s_ = 0;    ///< its duration; 0: none
  double since_s_ = 0;
};

// Where a person's parts are in fixed things, by geometry alone: an engine does not collide what it
// moves with what it never moves. Tested by tests/physics/person/fixed_things_test.cc

/// A part of a person that touches a fixed thing.
struct FixedTouch {
  int part = 0;  ///< counted from her head
  BodyIndex thing = {};
  double depth_m = 0;                                 ///< how deep the part is in it
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();    ///< on the part
  Eigen::Vector3d nhat_W = Eigen::Vector3d::UnitZ();  ///< out of the thing
};

class FixedThings {
 public:
  /// `scene` must outlive it.
  explicit FixedThings(const Scene& scene);

  /// What the parts of a person touch at these poses, by part and thing; not what she stands on.
  std::vector<FixedTouch> TouchedBy(const Person& person, const std::vector<Pose>& places) const;

 private:
  struct Thing {
    BodyIndex body = {};
    Eigen::AlignedBox3d bounds_W_m;
  };
  const Scene& scene_;
  std::vector<Thing> things_;
};

/// As contacts without an impulse: what is moved along its path bears no load.
void AddContacts(const Person& person, const std::vector<FixedTouch>& touches, Snapshot& snapshot);

}  // namespace prehend::physics
