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

#include "physics/pose.h"

namespace prehend::physics {

enum class Approach { kAuto, kAbove, kSide };

struct ReachStep {  ///< move to where the style's closed grasp would hold the object
  std::string object;
  std::string style = "wrap";
  Approach approach = Approach::kAuto;
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();  ///< added to the grasp pose, world axes
  std::optional<Eigen::Vector3d> point_m;  ///< what to grasp, in the object's frame; else its centre
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
struct TimedPose {
  double t_s = 0;  ///< since the step's start, increasing
  Pose X_WH;
  std::optional<double> trigger;
};
struct PosesStep {  ///< raw 6D way-points
  std::vector<TimedPose> poses;
};
using StepAction = std::variant<WaitStep, ReachStep, TriggerStep, MoveStep, CarryStep, PlaceStep,
                                RetreatStep, FollowJointStep, PosesStep>;

struct Step {
  int hand = 0;  ///< index into Scene::hands
  StepAction action;
  double over_s = 0.5;
};

struct Beat {
  std::vector<Step> steps;  ///< at most one per hand
};

struct Script {
  std::vector<Beat> beats;
  double settle_s = 0.5;  ///< simulated on after the last beat
};

}  // namespace prehend::physics
