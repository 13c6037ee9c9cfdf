// SPDX-License-Identifier: Apache-2.0
#include "grammar/builtins.h"

#include <numbers>

namespace prehend::grammar {
namespace {

constexpr Dimension kRadiansPerSecond{.time = -1, .angle = 1};
constexpr Range kShare{.low = 0, .high = 1};
constexpr Range kNotNegative{.low = 0};

}  // namespace

std::span<const Builtin> Builtins() {
  using A = Argument;
  using T = Type;
  static const std::vector<Builtin> kBuiltins = {
      {"touching", Op::kHolds, T::kTruth, kPlain, {A::kEntity, A::kEntity}, "their surfaces touch"},
      {"in_sphere", Op::kInSphere, T::kTruth, kPlain, {A::kPosition, A::kPosition, A::kLength},
       "(what, centre, radius): a position, or any part of an entity's box, is in the sphere"},
      {"in_cylinder", Op::kInCylinder, T::kTruth, kPlain, {A::kPosition, A::kPosition, A::kLength, A::kLength},
       "(position, centre, radius, height): in the upright cylinder, at most height above or below its centre"},
      {"inside", Op::kInside, T::kTruth, kPlain, {A::kEntity, A::kEntity},
       "the centre of the first is in the second's box, or in its ball if it is round"},
      {"part_of", Op::kPartOf, T::kTruth, kPlain, {A::kEntity, A::kEntity}, "the first is a part of the second, or of a part of it"},
      {"gazed", Op::kGazed, T::kTruth, kPlain, {A::kEntity, A::kEntity}, "the first looks at the second"},
      {"sensor_set", Op::kSensorSet, T::kTruth, kPlain, {A::kHand, A::kSet, A::kThing},
       "(hand, set, object): the object touches this sensor set of the hand; a name, or a number from 1"},
      {"trigger", Op::kTrigger, T::kNumber, kPlain, {A::kHand}, "commanded grip, 0 open .. 1 closed", kShare},
      {"sensor_sets", Op::kSensorSets, T::kNumber, kPlain, {A::kHand, A::kThing},
       "how many sensor sets of the hand the object touches", {.low = 0, .high = 32, .whole = true}},
      {"up", Op::kUp, T::kNumber, kPlain, {A::kEntity, A::kEntity},
       "cosine between up and the contact normal on the first: 1 held from below, 0 side by side, -1 not touching", {.low = -1, .high = 1}},
      {"force", Op::kForceBetween, T::kNumber, kNewtons, {A::kEntity, A::kEntity}, "normal force between them", kNotNegative},
      {"touch_speed", Op::kTouchSpeed, T::kNumber, kMetresPerSecond, {A::kEntity, A::kEntity},
       "how fast, up or down, their surfaces move against each other where they touch", kNotNegative},
      {"gap", Op::kGap, T::kNumber, kMetres, {A::kHand, A::kThing}, "smallest distance from the hand to the object's box", kNotNegative},
      {"closing_speed", Op::kClosingSpeed, T::kNumber, kMetresPerSecond, {A::kHand, A::kThing},
       "how fast the gap shrinks, from one frame to the next"},
      {"surface_speed", Op::kSurfaceSpeed, T::kNumber, kMetresPerSecond, {A::kHand},
       "of the fastest piece of the hand's surface, from one frame to the next", kNotNegative},
      {"distance", Op::kDistance, T::kNumber, kMetres, {A::kPosition, A::kPosition}, "between two positions", kNotNegative},
      {"height", Op::kHeight, T::kNumber, kMetres, {A::kPosition}, "above the world's origin"},
      {"speed", Op::kSpeed, T::kNumber, kMetresPerSecond, {A::kEntity}, "of the entity's origin", kNotNegative},
      {"vertical_speed", Op::kVerticalSpeed, T::kNumber, kMetresPerSecond, {A::kEntity}, "upwards"},
      {"relative_vertical_speed", Op::kRelativeVerticalSpeed, T::kNumber, kMetresPerSecond, {A::kEntity, A::kEntity},
       "upwards, of the first against the point of the second where the first is"},
      {"speed_along", Op::kSpeedAlong, T::kNumber, kMetresPerSecond, {A::kEntity, A::kEntity},
       "horizontal speed of the first against the point of the second where the first is", kNotNegative},
      {"drift_along", Op::kDriftAlong, T::kNumber, kMetresPerSecond, {A::kEntity, A::kEntity, A::kWindow},
       "(a, b, window): how far a gets horizontally, as seen from b, from half the window before to half of it after, "
       "per time", kNotNegative},
      {"turn_rate", Op::kTurnRate, T::kNumber, kRadiansPerSecond, {A::kEntity, A::kEntity, A::kWindow},
       "(a, b, window): how fast the direction in which a moves horizontally, as seen from b, turns to the left"},
      {"tilt", Op::kTilt, T::kNumber, kRadians, {A::kEntity}, "angle between the entity's own z axis and up", {.low = 0, .high = std::numbers::pi}},
      {"joint_fraction", Op::kJointFraction, T::kNumber, kPlain, {A::kJointed}, "of a moving part, 0 closed .. 1 open", kShare},
      {"joint_angle", Op::kJointAngle, T::kNumber, kRadians, {A::kJointed}, "of a part on a hinge"},
      {"joint_travel", Op::kJointTravel, T::kNumber, kMetres, {A::kJointed}, "of a part on a slide"},
      {"weight", Op::kWeight, T::kNumber, kNewtons, {A::kThing}, "of the thing; of a fixed one, infinite", kNotNegative},
      {"strength", Op::kStrength, T::kNumber, kNewtons, {A::kHand}, "the weight that the hand can lift", kNotNegative},
      {"rate", Op::kRate, T::kNumber, kPlain, {A::kNumber, A::kWindow},
       "(value, window): how fast a value grows, from half the window before to half of it after"},
      {"position", Op::kPosition, T::kPosition, kMetres, {A::kEntity}, "of the entity's origin"},
      {"position_on", Op::kPositionOn, T::kPosition, kMetres, {A::kEntity, A::kEntity},
       "of the first's origin as seen from the second, so that it stays when both move together"},
      {"ahead", Op::kAhead, T::kPosition, kMetres, {A::kHand, A::kLength}, "the point this far in front of the palm"},
      {"abs", Op::kAbs, T::kNumber, kPlain, {A::kNumber}, "the value without its sign", kNotNegative},
  };
  return kBuiltins;
}

const Builtin* FindBuiltin(std::string_view name) {
  for (const Builtin& builtin : Builtins()) {
    if (builtin.name == name) return &builtin;
  }
  return nullptr;
}
const Builtin* FindBuiltin(Op op) {
  for (const Builtin& builtin : Builtins()) {
    if (builtin.op == op) return &builtin;
  }
  return nullptr;
}

}  // namespace prehend::grammar
