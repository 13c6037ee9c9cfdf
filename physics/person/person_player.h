// SPDX-License-Identifier: Apache-2.0
// Plays the steps of a script for one person: where she stands, how she leans, where her limbs go
// and where she looks. Her arms follow the hands of the scene. Nothing pushes her back: a person is
// kinematic. Tested by tests/physics/person/person_player_test.cc
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
  /// `scene` and `script` must outlive the player. `person` is an index into Scene::persons.
  PersonPlayer(const Scene& scene, const Script& script, int person);

  /// These steps of the script begin with the tick after `now`: what her eyes follow, and those of
  /// her own.
  void Begin(std::size_t stage, const std::vector<std::size_t>& hands_steps,
             const std::vector<std::size_t>& person_steps, const Snapshot& now);
  /// Moves her parts for the tick after `now`.
  void Advance(const Snapshot& now, World& world);
  /// What she sees in a world that has stepped since her last Advance().
  GazeState See(const World& world) const;

  const BodyTargets& targets() const { return targets_; }
  /// The fixed things that she has touched since her last Advance().
  const std::vector<FixedTouch>& touches() const { return touches_; }
  /// Distance by which a limb ends before the hand of the scene that it follows, or before where
  /// its step wants it, metres; 0 if it does neither. `limb`: index into BodyTargets::limbs.
  double LimbIsShortBy(int limb) const;
  /// Distance of her recorded head from the neck of her body, metres; 0 without either.
  double HeadIsOffBy() const;

 private:
  /// A minimum-jerk motion of one quantity.
  struct Motion {
    double from = 0, to = 0;
    double begin_s = 0, duration_s = 0;
    double At(double t_s) const;
  };
  /// How a motion gives way to resistance.
  struct Yielding {
    std::optional<double> max_force_n;  ///< force above which it yields
    double pace = 1;                    ///< share of the full speed, less than 1 under resistance
    double behind_s = 0;                ///< delay that yielding has caused
  };
  struct LimbMotion {
    LimbEnd end = LimbEnd::kRightWrist;
    Eigen::Vector3d from_S_m = Eigen::Vector3d::Zero();  ///< in the frame of her stance
    Eigen::Vector3d to_S_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d forearm_S = Eigen::Vector3d::UnitZ();  ///< when the step began
    bool to_rest = true;
    Motion progress;
    Yielding yielding;
  };
  struct RecordedBody {
    PostureTrack track;
    double begin_s = 0;
  };
  struct Leaving {  ///< the transition from the end of a recording
    Posture from;
    Motion progress;
  };
  struct HeadLeaving {  ///< the same of her head: its pose over the end of the neck, along the
                        ///< world
    Pose from;
    Motion progress;
  };
  class Resolver;

  BodyTargets::Limb LimbAt(int limb, const Snapshot& now) const;
  /// Where she stands and how she leans; where her limbs go.
  void AimStance();
  void AimLimbs(const Snapshot& now);
  /// What yields and goes into a fixed thing, or deeper into it, as all is aimed now.
  std::vector<Yielding*> WhatGoesIntoFixed();
  /// Stops it for this tick where it begins to touch.
  void StopBeforeFixed(const Snapshot& now);
  /// Slows a motion down that meets too much resistance, and speeds it up again afterwards.
  void Yield(Yielding& motion, double resistance_n) const;
  /// Force of contacts against the motion of a limb, or of her walk, newtons.
  double ResistanceTo(int limb, const Snapshot& now) const;
  double ResistanceToWalk(const Snapshot& now) const;
  /// Force of contacts of her parts from `begin` to before `end` against a way.
  double ResistanceTo(int begin, int end, const Eigen::Vector3d& way, const Snapshot& now) const;
  void HoldPosture();
  void StandBelow(const Posture& posture);
  /// A head without a body stays where its recording ends: her stance comes below it.
  void StandBelowHead();
  void TurnHead(const Snapshot& now);
  /// Her head as it is to be now: from where a recording has left it.
  void LeaveRecordedHead();

  const Scene& scene_;
  const Script& script_;
  const Person& person_;
  FixedThings fixed_;
  int index_ = 0;
  double t_s_ = 0;  ///< since the first tick
  std::int64_t tick_ = 0;
  Motion x_, y_, yaw_, lean_, sway_ahead_, sway_left_;
  Yielding walk_;  ///< of x_ and y_
  std::array<LimbMotion, 4> limbs_;
  BodyTargets targets_;
  std::vector<Pose> places_;
  std::vector<FixedTouch> touches_;
  GazeLeader leader_;
  Eyes eyes_;
  std::optional<GazeTarget> told_;                     ///< the script's target; overrides her own
  std::optional<std::pair<Trajectory, double>> head_;  ///< recorded motion and its begin, seconds
  std::optional<RecordedBody> body_;
  std::optional<Leaving> leaving_;
  std::optional<HeadLeaving> head_leaving_;
  /// So many parts, from the head on, do in the next tick: a recording of them begins at once.
  std::size_t jumping_ = 0;
  EyesAndHead gaze_;
};

}  // namespace prehend::physics
