// SPDX-License-Identifier: Apache-2.0
// What hands and persons do: a list of stages. In one stage every named actor performs one step, or
// several one after another, and the stage ends with its last step. Steps move the *tracked target*
// that the hand's PIDs follow (minimum jerk, Flash & Hogan 1985). A step is resolved into
// way-points when it starts, from the poses in the world at that time. Tested by
// tests/physics/hand/script_player_test.cc
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "physics/base/pose.h"
#include "physics/base/visitors.h"
#include "physics/motion/posture.h"
#include "physics/motion/trajectory.h"
#include "physics/scene/scene.h"

namespace prehend::physics {

enum class Approach { kAuto, kAbove, kSide };

struct ReachStep {  ///< move to where the closed grasp would hold the object
  std::string object;
  std::string style = "wrap";
  Approach approach = Approach::kAuto;
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();  ///< added to the grasp pose, world axes
  std::optional<Eigen::Vector3d>
      point_m;  ///< what to grasp, in the object's frame; else the centre
};
struct TriggerStep {  ///< close_to, open_to: the trigger goes linearly to this value, 0..1
  double trigger = 0;
};
struct MoveStep {  ///< lift_by_m (z only), move_by_m: relative, world axes
  Eigen::Vector3d by_m = Eigen::Vector3d::Zero();
};
struct CarryStep {  ///< carry_to_m: the held object's centre goes to x, y at its height
  Eigen::Vector2d to_m = Eigen::Vector2d::Zero();
};
struct PlaceStep {  ///< place_on: lower the held object to the support's surface below it
  std::string support;
};
struct RetreatStep {  ///< retreat_by_m: back along the last direction of arrival
  double by_m = 0.2;
};
struct FollowJointStep {  ///< the target moves along the free axis of the entity's joint
  std::string entity;
  double to = 1;  ///< to this fraction of the joint's range
};
struct WaitStep {};
/// What a way-point is relative to, as it is when the step begins.
struct PoseFrame {
  bool own_hand = false;  ///< the hand's own tracked target
  std::string name = {};  ///< else this body, or the palm of this hand; empty: the world
  /// Only its place counts: way-points are added to it along the world's axes. The hand's own
  /// orientation is then turned by theirs about these axes.
  bool world_axes = false;
};
struct PosesStep {  ///< 6D way-points
  std::vector<TimedPose> poses;
  std::string style = {};              ///< new grasp style; empty: unchanged
  std::vector<PoseFrame> frames = {};  ///< of each way-point; empty: all in the world
};
struct TurnHandStep {                                ///< turn_by_deg: about the palm's centre
  Eigen::Vector3d by_rad = Eigen::Vector3d::Zero();  ///< about this axis, by its length
  bool own_axes = false;                             ///< the axis is one of the hand, not the world
};
struct OrbitStep {  ///< around the vertical through a thing's centre; the hand turns with it
  std::string around;
  double by_rad = 0;
  std::optional<double> at_m;  ///< distance from it in the end; else as now
};
struct PressStep {  ///< presses, by itself or with what it holds
  std::string against;
  double force_n = 0;
  Eigen::Vector3d along_W = -Eigen::Vector3d::UnitZ();  ///< unit
};
using StepAction =
    std::variant<WaitStep, ReachStep, TriggerStep, MoveStep, CarryStep, PlaceStep, RetreatStep,
                 FollowJointStep, PosesStep, TurnHandStep, OrbitStep, PressStep>;

/// What ends a step before its time. If it never happens the script cannot continue.
struct Until {
  std::string thing;
  /// The hand, or the thing that it last reached for and touches, touches the thing; or, if set,
  /// the hand's surface is nearer to it than this.
  std::optional<double> gap_m;
  bool or_go_on = false;  ///< the script continues also if it never happens
  std::string who = {};  ///< instead of the hand: another one, or a body that is to touch the thing
};

/// When it is a step's turn: at the begin of its stage, but after the step before it of the same
/// actor, and as this says. Names are those of steps of the same stage; empty: none.
struct StepOrder {
  std::string name = {};   ///< of the step itself
  std::string after = {};  ///< its turn comes when this one has ended,
  std::string with = {};   ///< or begins
};

struct Step {
  HandIndex hand = HandIndex(0);
  StepAction action;
  double over_s = 0.5;
  std::optional<Until> until = {};
  double delay_s = 0;           ///< after its turn has come; what it says is resolved then
  std::string written_at = {};  ///< "FILE:LINE:COLUMN", for what is said about it; may be empty
  StepOrder order = {};
  /// Of a MoveStep, CarryStep or PlaceStep: the hand turns so that what it holds stands as it stood
  /// when the hand closed. None: only in a PlaceStep, where the support is level.
  std::optional<bool> keep_upright = {};
};

struct LookAtStep {
  std::variant<std::string, Eigen::Vector3d> target;  ///< an entity or a point of the world
};
struct EyesStep {  ///< ends a LookAtStep
  Eyes eyes = Eyes::kLead;
};
struct WalkStep {  ///< her stance moves there
  Eigen::Vector2d to_m = Eigen::Vector2d::Zero();
  /// If set, she slows down so that her body pushes with no more than this force, newtons.
  std::optional<double> max_force_n = std::nullopt;
};
struct TurnStep {
  double to_rad = 0;  ///< yaw of her stance
};
struct LeanStep {
  double to_rad = 0;  ///< lean of the trunk, forwards
};
struct SwayStep {  ///< her hips move ahead and to her left, her feet do not
  Eigen::Vector2d by_m = Eigen::Vector2d::Zero();
};
/// The points of a body that can be moved to a position.
enum class LimbEnd { kRightElbow, kLeftElbow, kRightWrist, kLeftWrist, kRightFoot, kLeftFoot };
struct MoveLimbStep {
  LimbEnd limb = LimbEnd::kRightFoot;
  std::optional<Eigen::Vector3d> to_m = std::nullopt;  ///< none: back to its rest position
  /// If set, the limb yields: it slows down so that it pushes with no more than this force,
  /// newtons.
  std::optional<double> max_force_n = std::nullopt;
};
struct HeadPosesStep {  ///< recorded head; the eyes look along its x
  std::vector<TimedPose> poses;
};
struct BodyPosesStep {  ///< recorded whole body
  std::vector<TimedPosture> postures;
};
using PersonAction = std::variant<WaitStep, LookAtStep, EyesStep, WalkStep, TurnStep, LeanStep,
                                  SwayStep, MoveLimbStep, HeadPosesStep, BodyPosesStep>;

struct PersonStep {
  int person = 0;  ///< index into Scene::persons
  PersonAction action;
  double over_s = 0.5;
  std::optional<Until> until = {};  ///< of somebody or something else
  double delay_s = 0;               ///< after its turn has come
  StepOrder order = {};
};

struct ScriptStage {
  std::vector<Step> steps;  ///< of a hand one, or several one after another
  std::vector<PersonStep> person_steps = {};
};

struct Script {
  std::vector<ScriptStage> stages;
  double settle_s = 0.5;  ///< simulated time after the last stage
};

}  // namespace prehend::physics
