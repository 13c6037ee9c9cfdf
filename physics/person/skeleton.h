// SPDX-License-Identifier: Apache-2.0
// A human body as capsules: its parts, their lengths and radii, and their poses for given targets.
// Proportions are shares of the height (Drillis & Contini 1966, in Winter, Biomechanics and Motor
// Control of Human Movement, 2009). Tested by tests/physics/person/skeleton_test.cc
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "physics/motion/posture.h"
#include "physics/motion/script.h"
#include "physics/scene/scene.h"

namespace prehend::physics {

/// What a body has to do: stance, lean, limbs and head; the skeleton is solved for these targets.
struct BodyTargets {
  Pose X_WS;            ///< her stance
  double lean_rad = 0;  ///< of the trunk, forwards
  /// Offset of her hips from above her feet: ahead, and to the left. Her shoulders do not move.
  Eigen::Vector2d sway_m = Eigen::Vector2d::Zero();
  /// Targets of arms and legs.
  struct Limb {
    LimbEnd end = LimbEnd::kRightWrist;  ///< the point whose target is `p_W_m`
    Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
    /// Direction of the forearm, unit; only if the end is an elbow.
    Eigen::Vector3d forearm_W = Eigen::Vector3d::UnitZ();
  };
  std::array<Limb, 4> limbs;  ///< right arm, left arm, right leg, left leg
  Pose X_WHead;               ///< x is the direction of the face
  /// If set, it replaces all of the above except the head and arms that follow hands of the scene.
  std::optional<Posture> posture;
};

/// Index into BodyTargets::limbs.
int LimbOf(LimbEnd end);

/// The hand of the scene that a limb follows, or none.
HandIndex HandAt(int limb, const Person& person);

/// The rest position of a limb: of its wrist, or of the middle of its foot.
BodyTargets::Limb RestOf(int limb, const Person& person, const BodyTargets& targets);
/// Position of this end of a limb, metres.
Eigen::Vector3d PlaceOf(LimbEnd end, const Person& person, const BodyTargets& targets);
/// Direction of the forearm of an arm, unit.
Eigen::Vector3d ForearmOf(LimbEnd end, const Person& person, const BodyTargets& targets);
/// The same for an arm that pushes with its elbow: folded up, towards the other shoulder.
Eigen::Vector3d FoldedForearm(LimbEnd end, const Pose& X_WS);
/// The joint between neck and head, metres.
Eigen::Vector3d NeckTop(const Person& person, const BodyTargets& targets);
/// Sine of the steepest pitch of a head: near the vertical its yaw would be undefined.
inline constexpr double kSteepestHead = 0.98;
/// Pose of a head that looks in this direction.
Pose HeadToward(const Person& person, const Eigen::Vector3d& p_W_neck,
                const Eigen::Vector3d& toward_W);
/// Pose of the head for targets that have a posture.
Pose HeadOfPosture(const Person& person, const BodyTargets& targets);
/// The posture that solves the targets; their own posture if they have one.
Posture PostureOf(const Person& person, const BodyTargets& targets);
/// Length from the hip joint over the knee to the ankle, metres.
double LegLength(double height_m);
/// Height of the ankles over the floor in stance, metres.
double AnkleHeight(double height_m);
/// The point between the eyes, metres.
Eigen::Vector3d EyesOf(const Person& person, const Pose& X_WHead);
/// Position of the wrist in the frame of a hand's palm: the round end of the forearm ends where the
/// palm begins.
Eigen::Vector3d WristInHand(const Person& person, const HandModel& model);

/// Targets of a person who stands and looks ahead, with arms hanging or at the hands of the scene.
BodyTargets Standing(const Scene& scene, const Person& person);

/// The range of PartsOf() that belongs to a limb, hand or foot included.
struct PartRange {
  int begin = 0, end = 0;
};
PartRange PartsOfLimb(const Person& person, int limb);

/// The parts as kinematic bodies without poses, the head first: "anna", "anna_neck", ...
std::vector<Body> PartsOf(const Person& person);
/// Poses of the parts, in that order. A part rotates about its own axis as little as possible from
/// `before`: the last poses, or empty.
std::vector<Pose> PlacesOf(const Person& person, const BodyTargets& targets,
                           const std::vector<Pose>& before);

}  // namespace prehend::physics
