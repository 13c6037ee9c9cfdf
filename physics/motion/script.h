// SPDX-License-Identifier: Apache-2.0
// What the hands are told to do: a list of beats; in one beat every named hand performs one step,
// the beat ends with its longest step. Steps move the *tracked target* that the hand's PIDs follow
// (minimum jerk, Flash & Hogan 1985). A step is resolved into way-points when it starts, from the
// poses that the world has then.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "physics/motion/posture.h"
#include "physics/motion/trajectory.h"
#include "physics/scene/pose.h"
#include "physics/scene/scene.h"

namespace prehend::physics {

enum class Approach { kAuto, kAbove, kSide };

struct ReachStep {  ///< move to where the style's closed grasp would hold the object
  std::string object;
  std::string style = "wrap";
  Approach approach = Approach::kAuto;
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();  ///< added to the grasp pose, world axes
  std::optional<Eigen::Vector3d>
      point_m;  ///< what to grasp, in the object's frame; else its centre
};
struct TriggerStep {  ///< close_to, open_to: the analog trigger goes linearly to this value, 0..1
  double trigger = 0;
};
struct MoveStep {  ///< lift_by_m (z only), move_by_m: relative, world axes
  Eigen::Vector3d by_m = Eigen::Vector3d::Zero();
};
struct CarryStep {  ///< carry_to_m: the held object's centre goes to these x, y, height kept
  Eigen::Vector2d to_m = Eigen::Vector2d::Zero();
};
struct PlaceStep {  ///< place_on: lower until the held object's lowest point meets the support's
                    ///< top
  std::string support;
};
struct RetreatStep {  ///< retreat_by_m: back along the direction the hand came from
  double by_m = 0.2;
};
struct FollowJointStep {  ///< the target goes the way that the entity's joint leaves free
  std::string entity;
  double to = 1;  ///< until the joint stands at this fraction of its range
};
struct WaitStep {};
struct PosesStep {  ///< raw 6D way-points
  std::vector<TimedPose> poses;
  std::string style = {};  ///< the hand takes this grasp style; empty: it keeps its own
};
using StepAction = std::variant<WaitStep, ReachStep, TriggerStep, MoveStep, CarryStep, PlaceStep,
                                RetreatStep, FollowJointStep, PosesStep>;

struct Step {
  int hand = 0;  ///< index into Scene::hands
  StepAction action;
  double over_s = 0.5;
};

struct LookAtStep {
  std::variant<std::string, Eigen::Vector3d> target;  ///< an entity, or a point of the world
};
struct EyesStep {  ///< no longer at what a LookAtStep said
  Eyes eyes = Eyes::kLead;
};
struct WalkStep {  ///< her stand glides there
  Eigen::Vector2d to_m = Eigen::Vector2d::Zero();
};
struct TurnStep {
  double to_rad = 0;  ///< yaw of her stand
};
struct LeanStep {
  double to_rad = 0;  ///< of the trunk, forwards
};
struct SwayStep {  ///< her hips go out from over her feet, which stay; ahead and to her left
  Eigen::Vector2d by_m = Eigen::Vector2d::Zero();
};
/// What of a body can be sent to a place.
enum class LimbEnd { kRightElbow, kLeftElbow, kRightWrist, kLeftWrist, kRightFoot, kLeftFoot };
struct MoveLimbStep {
  LimbEnd limb = LimbEnd::kRightFoot;
  std::optional<Eigen::Vector3d> to_m = std::nullopt;  ///< none: back to where it hangs or stands
  /// It yields: it slows down so that what resists it is pushed with no more than this, newtons.
  std::optional<double> most_n = std::nullopt;
};
struct HeadPosesStep {  ///< recorded head: x of it is where the eyes look
  std::vector<TimedPose> poses;
};
struct BodyPosesStep {  ///< the whole body, recorded
  std::vector<TimedFigure> figures;
};
using PersonAction = std::variant<WaitStep, LookAtStep, EyesStep, WalkStep, TurnStep, LeanStep,
                                  SwayStep, MoveLimbStep, HeadPosesStep, BodyPosesStep>;

struct PersonStep {
  int person = 0;  ///< index into Scene::persons
  PersonAction action;
  double over_s = 0.5;
};

struct Beat {
  std::vector<Step> steps;                    ///< at most one per hand
  std::vector<PersonStep> person_steps = {};  ///< at most one per person
};

struct Script {
  std::vector<Beat> beats;
  double settle_s = 0.5;  ///< simulated on after the last beat
};

}  // namespace prehend::physics
