// SPDX-License-Identifier: Apache-2.0
// The table of the signals, and look-ups in it.
#include "grammar/analysis/builtins.h"

#include <algorithm>
#include <numbers>

namespace prehend::grammar {
namespace {

constexpr Dimension kRadiansPerSecond{.time = -1, .angle = 1};
constexpr Range kShare{.low = 0, .high = 1};
constexpr Range kNotNegative{.low = 0};
constexpr Range kAnyNumber{};

}  // namespace

std::span<const Builtin> Builtins() {
  using A = Argument;
  using S = Asks;
  using T = Type;
  using V = Threshold::Value;
  // One row per signal, in the order of the struct: name, node, type, dimension, arguments;
  // meaning; what it asks frames for, range, what it measures of a touch or a grip, default of the
  // last argument.
  // clang-format off
  static const std::vector<Builtin> kBuiltins = {
      {"touching",                Op::kHolds,                 T::kTruth,    kPlain,            {A::kEntity, A::kEntity},
       "their surfaces touch",
       S::kTouching, kAnyNumber},
      {"in_sphere",               Op::kInSphere,              T::kTruth,    kPlain,            {A::kPosition, A::kPosition, A::kLength},
       "(what, centre, radius): a position, or any point of an entity, is in the sphere",
       S::kPoses, kAnyNumber},
      {"in_cylinder",             Op::kInCylinder,            T::kTruth,    kPlain,            {A::kPosition, A::kPosition, A::kLength, A::kLength},
       "(position, centre, radius, height): in the upright cylinder, at most height above or "
       "below its centre",
       S::kPoses, kAnyNumber},
      {"inside",                  Op::kInside,                T::kTruth,    kPlain,            {A::kEntity, A::kEntity},
       "the centre of the first is in the second's box, or in its ball if it is round",
       S::kPoses, kAnyNumber},
      {"nearest",                 Op::kNearest,               T::kTruth,    kPlain,            {A::kEntity, A::kEntity},
       "of all entities of the first's class, its surface is nearest to the second's origin",
       S::kPoses, kAnyNumber},
      {"part_of",                 Op::kPartOf,                T::kTruth,    kPlain,            {A::kEntity, A::kEntity},
       "the first is a part of the second, or of a part of it",
       S::kNothing, kAnyNumber},
      {"gazed",                   Op::kGazed,                 T::kTruth,    kPlain,            {A::kEntity, A::kEntity},
       "the first looks at the second",
       S::kPoses, kAnyNumber},
      {"sensor_set",              Op::kSensorSet,             T::kTruth,    kPlain,            {A::kHand, A::kSet, A::kThing},
       "(hand, set, object): the object touches this sensor set of the hand; a name, or a number"
       " from 1",
       S::kTouchValues, kAnyNumber},
      {"trigger",                 Op::kTrigger,               T::kNumber,   kPlain,            {A::kHand},
       "commanded grip, 0 open .. 1 closed",
       S::kGrip, kShare, Measured{V::kTrigger, V::kTrigger}},
      {"sensor_sets",             Op::kSensorSets,            T::kNumber,   kPlain,            {A::kHand, A::kThing},
       "how many sensor sets of the hand the object touches",
       S::kTouchValues, {0, 32, true}, Measured{V::kSensorSets, V::kSensorSets}},
      {"up",                      Op::kUp,                    T::kNumber,   kPlain,            {A::kEntity, A::kEntity},
       "cosine between up and the contact normal on the first: 1 held from below, 0 side by "
       "side, -1 not touching",
       S::kTouchValues, {-1, 1}, Measured{V::kUpOnFirst, V::kUpOnSecond}},
      {"force",                   Op::kForceBetween,          T::kNumber,   kNewtons,          {A::kEntity, A::kEntity},
       "normal force between them",
       S::kTouchValues, kNotNegative, Measured{V::kForce, V::kForce}},
      {"touch_speed",             Op::kTouchSpeed,            T::kNumber,   kMetresPerSecond,  {A::kEntity, A::kEntity},
       "how fast, up or down, their surfaces move against each other where they touch",
       S::kTouchValues, kNotNegative, Measured{V::kVerticalSpeed, V::kVerticalSpeed}},
      {"gap",                     Op::kGap,                   T::kNumber,   kMetres,           {A::kHand, A::kThing},
       "smallest distance from the hand's surface to the object's",
       S::kPoses, kNotNegative},
      {"clearance",               Op::kClearance,             T::kNumber,   kMetres,           {A::kEntity, A::kEntity},
       "how far the lowest point of the first is above the top of the second, or of the part of "
       "it that is nearest below or above; endless where the first is beside it",
       S::kPoses, kAnyNumber},
      {"closing_speed",           Op::kClosingSpeed,          T::kNumber,   kMetresPerSecond,  {A::kHand, A::kThing},
       "how fast the gap shrinks, from one frame to the next",
       S::kPoses, kAnyNumber},
      {"surface_speed",           Op::kSurfaceSpeed,          T::kNumber,   kMetresPerSecond,  {A::kHand},
       "of the fastest piece of the hand's surface, from one frame to the next",
       S::kPoses, kNotNegative},
      {"distance",                Op::kDistance,              T::kNumber,   kMetres,           {A::kPosition, A::kPosition},
       "between two positions",
       S::kPoses, kNotNegative},
      {"height",                  Op::kHeight,                T::kNumber,   kMetres,           {A::kPosition},
       "above the world's origin",
       S::kPoses, kAnyNumber},
      {"speed",                   Op::kSpeed,                 T::kNumber,   kMetresPerSecond,  {A::kEntity},
       "of the entity's origin",
       S::kPoses, kNotNegative},
      {"speed",                   Op::kSpeedOver,             T::kNumber,   kMetresPerSecond,  {A::kEntity, A::kWindow},
       "(a, window): how far the entity's origin gets from half the window before to half of it "
       "after, per time",
       S::kPoses, kNotNegative},
      {"relative_speed",          Op::kRelativeSpeed,         T::kNumber,   kMetresPerSecond,  {A::kEntity, A::kEntity},
       "of the first's origin against the point of the second where the first is",
       S::kPoses, kNotNegative},
      {"relative_speed",          Op::kRelativeSpeedOver,     T::kNumber,   kMetresPerSecond,  {A::kEntity, A::kEntity, A::kWindow},
       "(a, b, window): how far a's origin gets, as seen from b, from half the window before to "
       "half of it after, per time",
       S::kPoses, kNotNegative},
      {"vertical_speed",          Op::kVerticalSpeed,         T::kNumber,   kMetresPerSecond,  {A::kEntity},
       "upwards",
       S::kPoses, kAnyNumber},
      {"relative_vertical_speed", Op::kRelativeVerticalSpeed, T::kNumber,   kMetresPerSecond,  {A::kEntity, A::kEntity},
       "upwards, of the first against the point of the second where the first is",
       S::kPoses, kAnyNumber},
      {"speed_along",             Op::kSpeedAlong,            T::kNumber,   kMetresPerSecond,  {A::kEntity, A::kEntity},
       "how fast the first moves along the second, in the plane in which they touch",
       S::kPosesAndTouchValues, kNotNegative},
      {"drift_along",             Op::kDriftAlong,            T::kNumber,   kMetresPerSecond,  {A::kEntity, A::kEntity, A::kWindow},
       "(a, b, window): how far a gets along b, in the plane in which they touch, from half the "
       "window before to half of it after, per time",
       S::kPosesAndTouchValues, kNotNegative},
      {"turn_rate",               Op::kTurnRate,              T::kNumber,   kRadiansPerSecond, {A::kEntity, A::kEntity, A::kWindow, A::kLength},
       "(a, b, window [, shortest]): how fast the direction in which a moves horizontally, as "
       "seen from b, turns to the left; 0 where a way is shorter than 1 mm, or than `shortest`",
       S::kPoses, kAnyNumber, std::nullopt, 0.001},
      {"tilt",                    Op::kTilt,                  T::kNumber,   kRadians,          {A::kEntity},
       "angle between the entity's own z axis and up",
       S::kPoses, {0, std::numbers::pi}},
      {"joint_fraction",          Op::kJointFraction,         T::kNumber,   kPlain,            {A::kJointed},
       "of a moving part, 0 closed .. 1 open",
       S::kPoses, kShare},
      {"joint_angle",             Op::kJointAngle,            T::kNumber,   kRadians,          {A::kJointed},
       "of a part on a hinge",
       S::kPoses, kAnyNumber},
      {"joint_travel",            Op::kJointTravel,           T::kNumber,   kMetres,           {A::kJointed},
       "of a part on a slide",
       S::kPoses, kAnyNumber},
      {"weight",                  Op::kWeight,                T::kNumber,   kNewtons,          {A::kThing},
       "of the thing; of a fixed one, infinite",
       S::kNothing, kNotNegative},
      {"strength",                Op::kStrength,              T::kNumber,   kNewtons,          {A::kHand},
       "the weight that the hand can lift",
       S::kNothing, kNotNegative},
      {"rate",                    Op::kRate,                  T::kNumber,   kPlain,            {A::kNumber, A::kWindow},
       "(value, window): how fast a value grows, from half the window before to half of it after",
       S::kPoses, kAnyNumber},
      {"mean",                    Op::kMean,                  T::kNumber,   kPlain,            {A::kNumber, A::kWindow},
       "(value, window): of the frames at most half the window before or after",
       S::kPoses, kAnyNumber},
      {"min",                     Op::kMinimum,               T::kNumber,   kPlain,            {A::kNumber, A::kWindow},
       "(value, window): the smallest of the frames at most half the window before or after",
       S::kPoses, kAnyNumber},
      {"max",                     Op::kMaximum,               T::kNumber,   kPlain,            {A::kNumber, A::kWindow},
       "(value, window): the largest of the frames at most half the window before or after",
       S::kPoses, kAnyNumber},
      {"median",                  Op::kMedian,                T::kNumber,   kPlain,            {A::kNumber, A::kWindow},
       "(value, window): of the frames at most half the window before or after",
       S::kPoses, kAnyNumber},
      {"position",                Op::kPosition,              T::kPosition, kMetres,           {A::kEntity},
       "of the entity's origin",
       S::kPoses, kAnyNumber},
      {"position_on",             Op::kPositionOn,            T::kPosition, kMetres,           {A::kEntity, A::kEntity},
       "of the first's origin as seen from the second, so that it stays when both move together",
       S::kPoses, kAnyNumber},
      {"ahead",                   Op::kAhead,                 T::kPosition, kMetres,           {A::kHand, A::kLength},
       "the point this far in front of the palm",
       S::kPoses, kAnyNumber},
      {"abs",                     Op::kAbs,                   T::kNumber,   kPlain,            {A::kNumber},
       "the value without its sign",
       S::kNothing, kNotNegative},
  };
  // clang-format on
  return kBuiltins;
}

const Builtin* FindBuiltin(std::string_view name) {
  for (const Builtin& builtin : Builtins()) {
    if (builtin.name == name) return &builtin;
  }
  return nullptr;
}

const Builtin* FindBuiltin(std::string_view name, std::size_t arguments) {
  for (const Builtin& builtin : Builtins()) {
    if (builtin.name == name && builtin.arguments.size() == arguments) return &builtin;
  }
  return FindBuiltin(name);
}

const Builtin* FindBuiltin(Op op) {
  for (const Builtin& builtin : Builtins()) {
    if (builtin.op == op) return &builtin;
  }
  return nullptr;
}

Asks AskedBy(Op op) {
  if (op == Op::kSolidInSphere || op == Op::kDistanceAlong) return Asks::kPoses;
  if (op == Op::kTouchIn || op == Op::kNormalIn) return Asks::kPosesAndTouchValues;
  const Builtin* const signal = FindBuiltin(op);
  return signal == nullptr ? Asks::kNothing : signal->asks;
}

bool AsksTouchValues(Op op) {
  const Asks asks = AskedBy(op);
  return asks == Asks::kTouchValues || asks == Asks::kPosesAndTouchValues;
}

bool AsksPoses(Op op) {
  const Asks asks = AskedBy(op);
  return asks == Asks::kPoses || asks == Asks::kPosesAndTouchValues;
}

bool IsOverWindow(Op op) {
  const Builtin* const signal = FindBuiltin(op);
  return HasWindow(op) && std::ranges::count(signal->arguments, Argument::kNumber) > 0;
}

bool HasWindow(Op op) {
  const Builtin* const signal = FindBuiltin(op);
  return signal != nullptr && std::ranges::count(signal->arguments, Argument::kWindow) > 0;
}

}  // namespace prehend::grammar
