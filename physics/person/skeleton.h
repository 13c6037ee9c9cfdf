// SPDX-License-Identifier: Apache-2.0
// A human body as capsules: which parts there are, how long and thick they are, and where they
// stand in a posture. Proportions are shares of the height (Drillis & Contini 1966, in Winter,
// Biomechanics and Motor Control of Human Movement, 2009). Tested by
// tests/physics/person/skeleton_test.cc
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "physics/motion/posture.h"
#include "physics/motion/script.h"
#include "physics/scene/scene.h"

namespace prehend::physics {

/// What a person does with her body, apart from looking.
struct Posture {
  Pose X_WS;            ///< her stand
  double lean_rad = 0;  ///< of the trunk, forwards
  /// How far her hips are ahead and to the left of over her feet. Her shoulders stay there.
  Eigen::Vector2d sway_m = Eigen::Vector2d::Zero();
  /// Where the arms and legs go; see Limb.
  struct Limb {
    LimbEnd end = LimbEnd::kRightWrist;  ///< what `p_W_m` is about
    Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
    /// From the elbow on, unit; only of a limb whose end is an elbow.
    Eigen::Vector3d forearm_W = Eigen::Vector3d::UnitZ();
  };
  std::array<Limb, 4> limbs;  ///< right arm, left arm, right leg, left leg
  Pose X_WHead;               ///< its x is where the face looks
  /// All of the above but the arms that follow hands of the scene and the head is as here.
  std::optional<Figure> figure;
};

/// Index into Posture::limbs.
int LimbOf(LimbEnd end);

/// Where a limb hangs or stands when nobody moves it: wrists, and the middle of the feet.
Posture::Limb RestOf(int limb, const Person& person, const Posture& posture);
/// Where this end of a limb is in a posture.
Eigen::Vector3d PlaceOf(LimbEnd end, const Person& person, const Posture& posture);
/// Where the forearm of an arm goes from its elbow on, unit.
Eigen::Vector3d ForearmOf(LimbEnd end, const Person& person, const Posture& posture);
/// The same of an arm that pushes with its elbow: folded up, towards the other shoulder.
Eigen::Vector3d FoldedForearm(LimbEnd end, const Pose& X_WS);
/// Between the neck and the head, which turns about it.
Eigen::Vector3d NeckTop(const Person& person, const Posture& posture);
/// The head that looks this way from its neck.
Pose HeadToward(const Person& person, const Eigen::Vector3d& p_W_neck,
                const Eigen::Vector3d& toward_W);
/// The head of a posture that has a figure.
Pose HeadOfFigure(const Person& person, const Posture& posture);
/// A posture as a figure; its own, when it has one.
Figure FigureOf(const Person& person, const Posture& posture);
/// From the hip joint over the knee to the ankle, metres.
double LegLength(double height_m);
/// Of the ankles over the floor when she stands, metres.
double AnkleHeight(double height_m);
/// Between the eyes.
Eigen::Vector3d EyesOf(const Person& person, const Pose& X_WHead);
/// Where the wrist is in the frame of a hand's palm: so that the forearm's round end ends where the
/// palm begins.
Eigen::Vector3d WristInHand(const Person& person, const HandModel& model);

/// Standing, arms hanging or at the hands of the scene, looking ahead.
Posture Standing(const Scene& scene, const Person& person);

/// Which of PartsOf() belong to a limb, the hand or foot included.
struct PartRange {
  int begin = 0, end = 0;
};
PartRange PartsOfLimb(const Person& person, int limb);

/// The parts as kinematic bodies, the head first, without their places: "anna", "anna_neck", ...
std::vector<Body> PartsOf(const Person& person);
/// Where they are, in that order. A part turns about its axis as little as it can from `before`,
/// which are their last places, or nothing.
std::vector<Pose> PlacesOf(const Person& person, const Posture& posture,
                           const std::vector<Pose>& before);

}  // namespace prehend::physics
