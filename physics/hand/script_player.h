// SPDX-License-Identifier: Apache-2.0
// Plays a script: when a beat starts, each of its steps is resolved into a motion of a hand's
// tracked target, from the world as it is then. Hands without a step keep their target. Tested by
// tests/physics/hand/script_player_test.cc
#pragma once

#include <string>
#include <vector>

#include "physics/motion/script.h"
#include "physics/motion/trajectory.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"
#include "physics/world/world.h"

namespace prehend::physics {

/// What went on, and yet perhaps not as its author thinks.
struct ScriptNote {
  std::int64_t tick = 0;
  int hand = 0;  ///< index into Scene::hands
  std::string text;
};

class ScriptPlayer {
 public:
  /// `scene` must outlive the player.
  ScriptPlayer(const Scene& scene, Script script);

  /// Style of every hand at the first tick: the one of its first reach, so that fingers need not
  /// jump.
  static std::vector<int> FirstStyles(const Scene& scene, const Script& script);

  /// The commands for the tick that follows `now`. Null when the script is over or cannot go on
  /// (see problem()).
  const std::vector<HandCommand>* Advance(const Snapshot& now);

  /// The beats that began with the last Advance(), as indices into Script::beats.
  const std::vector<std::size_t>& begun() const { return begun_; }
  const Script& script() const { return script_; }

  /// Why the script cannot go on; empty if it can.
  const std::string& problem() const { return problem_; }
  /// The hand that has the problem.
  int problem_hand() const { return problem_hand_; }
  /// Of all steps so far.
  const std::vector<ScriptNote>& notes() const { return notes_; }

 private:
  struct HandState {
    TargetState target;  ///< where it is, or will be at the end of the motion
    Trajectory motion{TargetState{}};
    int style = 0;
    int object = -1;                                         ///< last one reached for
    Eigen::Vector3d came_along_W = Eigen::Vector3d::Zero();  ///< zero until the first reach
  };
  class Resolver;

  void StartBeat(const Snapshot& now);

  const Scene& scene_;
  Script script_;
  std::vector<HandState> hands_;
  std::vector<HandCommand> commands_;
  std::size_t beat_ = 0;  ///< the next one to start
  std::int64_t tick_in_beat_ = 0;
  std::int64_t beat_ticks_ = 0;
  std::vector<std::size_t> begun_;
  bool settling_ = false;
  std::string problem_;
  int problem_hand_ = -1;
  std::vector<ScriptNote> notes_;
};

/// Simulated length of a script, seconds: all beats and the settling.
double DurationOf(const Script& script);

}  // namespace prehend::physics
