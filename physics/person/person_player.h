// SPDX-License-Identifier: Apache-2.0
// Plays what a script tells its persons: where they stand, lean, put their limbs, and look. Arms
// follow the hands of the scene. Nothing pushes back: a person is kinematic. Tested by
// tests/physics/person/person_player_test.cc
#pragma once

#include <string>
#include <vector>

#include "physics/motion/posture.h"
#include "physics/motion/trajectory.h"
#include "physics/person/gaze.h"
#include "physics/person/skeleton.h"
#include "physics/world/world.h"

namespace prehend::physics {

class PersonPlayer {
 public:
  /// `scene` and `script` must outlive it. `person` is an index into Scene::persons.
  PersonPlayer(const Scene& scene, const Script& script, int person);

  /// This beat of the script begins with the tick that follows `now`.
  void Begin(std::size_t beat, const Snapshot& now);
  /// Moves her parts for the tick that follows `now`.
  void Advance(const Snapshot& now, World& world);
  /// What she sees, in a world whose last tick she has been moved for.
  GazeState See(const World& world) const;

  const Posture& posture() const { return posture_; }

 private:
  /// From where something is to where it shall be, with minimum jerk.
  struct Motion {
    double from = 0, to = 0;
    double begin_s = 0, duration_s = 0;
    double At(double t_s) const;
  };
  struct LimbMotion {
    LimbEnd end = LimbEnd::kRightWrist;
    Eigen::Vector3d from_S_m = Eigen::Vector3d::Zero();  ///< in the frame of her stand
    Eigen::Vector3d to_S_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d forearm_S = Eigen::Vector3d::UnitZ();  ///< where it was when the step began
    bool to_rest = true;
    Motion progress;
    std::optional<double> most_n;  ///< the limb yields to more than this
    double pace = 1;               ///< share of its speed that what resists leaves to it
    double behind_s = 0;           ///< how far it is behind its time, since it had to yield
  };
  struct RecordedBody {
    FigureTrack track;
    double begin_s = 0;
  };
  struct Leaving {  ///< from the end of a recording to what she does without
    Figure from;
    Motion progress;
  };
  class Resolver;

  Posture::Limb LimbAt(int limb, const Snapshot& now) const;
  /// Slows a limb down that meets more resistance than it may, and lets it catch its pace again.
  void Yield(int limb, const Snapshot& now);
  double ResistanceTo(int limb, const Snapshot& now) const;
  void HoldFigure();
  void StandBelow(const Figure& figure);
  void TurnHead(const Snapshot& now);

  const Scene& scene_;
  const Script& script_;
  const Person& person_;
  int index_ = 0;
  double t_s_ = 0;  ///< since the first tick
  std::int64_t tick_ = 0;
  Motion x_, y_, yaw_, lean_, sway_ahead_, sway_left_;
  std::array<LimbMotion, 4> limbs_;
  Posture posture_;
  std::vector<Pose> places_;
  GazeLeader leader_;
  Eyes eyes_;
  std::optional<GazeTarget> told_;                     ///< a script's target goes before her own
  std::optional<std::pair<Trajectory, double>> head_;  ///< recorded, and when it began
  std::optional<RecordedBody> body_;
  std::optional<Leaving> leaving_;
  EyesAndHead gaze_;
};

}  // namespace prehend::physics
