// SPDX-License-Identifier: Apache-2.0
// Plays a script for the hands. When a step begins it is resolved into a motion of a hand's tracked
// target, from the state of the world at that time. Hands without a step keep their target. A step
// that puts a thing down looks at the world until the thing stands: the target goes on down, and
// the stage (in an ordered stage: the step) lasts longer, if it does not. A guarded step ends when
// what it waits for happens, and with the last step the stage. Tested by
// tests/physics/hand/script_player_test.cc
#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "physics/motion/script.h"
#include "physics/motion/stage_clock.h"
#include "physics/motion/trajectory.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"
#include "physics/world/world.h"

namespace prehend::physics {

/// A remark on a step that was executed but perhaps not as its author intended.
struct ScriptNote {
  std::int64_t tick = 0;
  HandIndex hand = {};  ///< none: the text names its actor
  std::string text;
};

/// Steps of a stage whose turn has come.
struct BegunSteps {
  std::size_t stage = 0;                  ///< index into Script::stages
  std::vector<std::size_t> steps;         ///< of hands; those that have a delay begin after it
  std::vector<std::size_t> person_steps;  ///< that begin now
};

class ScriptPlayer {
 public:
  /// `scene` must outlive the player.
  ScriptPlayer(const Scene& scene, Script script);

  /// Style of every hand at the first tick: that of its first reach, so that fingers do not jump.
  static std::vector<int> FirstStyles(const Scene& scene, const Script& script);

  /// The commands for the tick after `now`, one per hand. Null if the script has ended or cannot
  /// continue (see problem()).
  const std::vector<HandCommand>* Advance(const Snapshot& now);

  /// What began with the last Advance().
  const std::vector<BegunSteps>& begun() const { return begun_; }
  const Script& script() const { return script_; }

  /// Why the script cannot continue; empty if it can.
  const std::string& problem() const { return problem_; }
  HandIndex problem_hand() const { return problem_hand_; }
  /// Remarks on all steps so far.
  const std::vector<ScriptNote>& notes() const { return notes_; }
  void AddNote(ScriptNote note) { notes_.push_back(std::move(note)); }

 private:
  /// A thing that is put down.
  struct Placing {
    BodyIndex body = {};
    BodyIndex support = {};
    double weight_n = 0;   ///< that its support must bear: its weight, per hand that holds it
    double borne_n = 0;    ///< what others than hands bear of it: a mean over some 20 ms
    bool touches = false;  ///< it is borne at this moment
    double lowered_m = 0;  ///< how far the target has gone beyond its motion
    /// Height that the palm got down to while the thing touched its support.
    double lowest_m = std::numeric_limits<double>::infinity();
    bool lifted_off = false;  ///< the hand sprang back with it
    bool Stands() const;
    /// The target's height that a motion asks for, and what became of it.
    double HeightOf(double motion_m) const {
      return lifted_off ? std::min(motion_m - lowered_m, lowest_m) : motion_m - lowered_m;
    }
  };
  /// What ends the present step before its time.
  struct Waiting {
    Until until;
    BodyIndex thing = {};
    bool met = false;
  };
  /// The target goes on along a direction until the force is reached.
  struct Pressing {
    BodyIndex against = {};
    double force_n = 0;
    Eigen::Vector3d along_W;
    double present_n = 0;  ///< a mean over some 20 ms
    double depth_m = 0;    ///< how far the target has gone
  };
  /// A note says that the hand has closed without holding `object`.
  struct GripNote {
    std::int64_t tick = 0;  ///< of the note
    BodyIndex object = {};
  };
  struct HandState {
    TargetState target;  ///< present target, or the one at the end of the motion
    Trajectory motion{TargetState{}};
    int style = 0;
    BodyIndex object = {};  ///< the body last reached for, or none
    Eigen::Vector3d came_along_W =
        Eigen::Vector3d::Zero();  ///< of the last arrival, turned with the hand; zero before it
    /// What turns it with the present step: the hand along its way-points, from here.
    std::optional<Eigen::Quaterniond> turns_from = std::nullopt;
    std::optional<Placing> placing = std::nullopt;
    std::optional<Waiting> waiting = std::nullopt;
    std::optional<Pressing> pressing = std::nullopt;
    /// The present step of its stage; none before the first.
    std::optional<std::size_t> step = std::nullopt;
    /// How far the target has given way since the step began: the hand rests at what holds it back.
    std::optional<Pose> yielded = std::nullopt;
    /// How fast it does so, where the palm has to keep up.
    Eigen::Vector3d yields_m_per_s = Eigen::Vector3d::Zero(),
                    yields_rad_per_s = Eigen::Vector3d::Zero();
    std::int64_t begin_tick = 0;  ///< when its motion began, after its stage began
    double pace = 1;              ///< share of its full speed; less where a guarded step brakes
    double behind_s = 0;          ///< delay that braking has caused
    std::int64_t late_ticks = 0;  ///< by which it lasts longer than planned
    std::string written_at = {};  ///< the present step
    bool closes = false;          ///< with the present step the trigger rises
    bool took = false;            ///< what stands, and it has not moved on since
    bool lets_go = false;         ///< it opens, held back by what it holds
    bool let_go = false;          ///< it has opened on what it reached for last
    std::optional<GripNote> grip_note = std::nullopt;
  };
  class Resolver;

  void StartStage();
  /// Ends and starts the steps of the present stage for which it is time.
  void Progress(const Snapshot& now);
  bool EndSteps(const Snapshot& now);
  bool StartSteps(const Snapshot& now);
  void StartStep(std::size_t index, const Snapshot& now);
  /// The hand rests where its target is.
  static void Settle(HandState& hand);
  /// Whether the stage is over; otherwise it may last longer, because of what is put down.
  bool EndStage(const Snapshot& now);
  /// When the hand's step should be over: in a plain stage with the stage.
  std::int64_t PlannedEnd(const HandState& hand) const;
  /// Since the motion of the hand began.
  double MotionTime(const HandState& hand) const;
  void Watch(const Snapshot& now);
  /// Whether what the hand puts down does not stand yet, and it is not too late.
  bool Waits(std::size_t hand, std::int64_t late_ticks) const;
  void CheckThatItStands(std::size_t hand, const Snapshot& now);
  /// Ends guarded steps, and with them perhaps the stage.
  void WatchGuards(const Snapshot& now);
  /// Slows a hand down that could not stop at its gap otherwise.
  void Brake(std::size_t hand, const Snapshot& now);
  void CheckGuard(std::size_t hand, const Snapshot& now);
  /// Ends steps of persons that wait for something.
  void WatchPersons(const Snapshot& now);
  /// Whether what a step of `own` (or of a person) waits for happens.
  bool Happens(const Until& until, HandIndex own, const Snapshot& now) const;
  /// Notes that a hand has closed beside what it reached for.
  void NoteTheGrip(std::size_t hand, const Snapshot& now);
  void NoteTheWay(std::size_t hand, const Snapshot& now);
  /// Fingers follow late: a hand that takes hold after all, before it opens, needs no note.
  void WithdrawNotes(const Snapshot& now);
  void Press(const Snapshot& now);
  /// A hand that is to rest, and cannot get to its target because of what it touches or holds, does
  /// not go on pushing: its target comes to it, as fast as the palm's integral term takes over.
  void GiveWay(const Snapshot& now);
  bool Rests(const HandState& hand) const;
  /// Whether its present step is one of the trigger.
  bool Grips(const HandState& hand) const;
  /// A hand that closes around what stands moves so that it goes on standing.
  void KeepStanding(std::size_t hand, const Snapshot& now);
  /// What a hand is about to take stands so.
  void RememberHowItStands(HandState& hand, const Snapshot& now);
  bool IsTouched(HandIndex hand, BodyIndex thing, const Snapshot& now) const;
  double GapTo(HandIndex hand, BodyIndex thing, const Snapshot& now) const;
  /// Where the hand's target is and how it moves.
  TargetState TargetOf(const HandState& hand) const;
  void Fail(HandIndex hand, const std::string& problem);

  const Scene& scene_;
  Script script_;
  std::vector<HandState> hands_;
  /// How a body stood when a hand closed around it.
  struct Standing {
    Eigen::Vector3d up_B;  ///< the direction in it that was up
    double low_m = 0;      ///< height of its lowest point
  };
  using Standings = std::vector<std::optional<Standing>>;
  Standings stood_;  ///< by body
  std::vector<HandCommand> commands_;
  std::size_t stage_ = 0;  ///< the next stage to start
  StageClock clock_;       ///< of the present one
  std::int64_t tick_in_stage_ = 0;
  std::int64_t late_ticks_ = 0;  ///< by which a plain stage lasts longer than planned
  std::vector<BegunSteps> begun_;
  bool settling_ = false;
  std::string problem_;
  HandIndex problem_hand_ = {};
  std::vector<ScriptNote> notes_;
};

}  // namespace prehend::physics
