// SPDX-License-Identifier: Apache-2.0
// The table of the operators, and look-ups in it.
#include "grammar/program/operators.h"

#include <algorithm>
#include <numbers>

namespace prehend::grammar {
namespace {

using A = Argument;
using F = Fact;
using S = Asks;
using T = Type;
using V = Threshold::Value;

constexpr Dimension kRadiansPerSecond{.time = -1, .angle = 1};
constexpr Range kShare{.low = 0, .high = 1};
constexpr Range kNotNegative{.low = 0};
constexpr Measured Both(V value) { return {value, value}; }
constexpr Operator Inner(Op op) { return {.op = op, .type = T::kTruth, .asks = S::kNothing}; }
constexpr Operator Made(Op op) {
  return {.op = op, .type = T::kNumber, .asks = S::kNothing, .is_made = true};
}
constexpr OverInterval::Part Now(Op op) { return {.op = op}; }
constexpr OverInterval::Part Begun(Op op, double number = 0) {
  return {.op = op, .at_begin = true, .number = number};
}

// The signals and tests stand in the order in which they are listed.
// clang-format off
constexpr Operator kTraits[] = {
    Inner(Op::kAnd), Inner(Op::kOr), Inner(Op::kNot), Inner(Op::kKnown), Inner(Op::kBegins), Inner(Op::kEnds),
    Inner(Op::kLess), Inner(Op::kLessEqual), Inner(Op::kGreater), Inner(Op::kGreaterEqual),
    Inner(Op::kEqual), Inner(Op::kNotEqual), Inner(Op::kOwns), Inner(Op::kIsA),
    {.op = Op::kHolds, .type = T::kTruth, .asks = S::kTouching, .name = "touching",
     .arguments = {A::kEntity, A::kEntity}, .meaning = "their surfaces touch"},
    {.op = Op::kInSphere, .type = T::kTruth, .asks = S::kPoses, .name = "in_sphere",
     .arguments = {A::kPosition, A::kPosition, A::kLength},
     .meaning = "(what, centre, radius): a position, or any point of an entity, is in the sphere"},
    {.op = Op::kSolidInSphere, .type = T::kTruth, .asks = S::kPoses},
    {.op = Op::kInCylinder, .type = T::kTruth, .asks = S::kPoses, .name = "in_cylinder",
     .arguments = {A::kPosition, A::kPosition, A::kLength, A::kLength},
     .meaning = "(position, centre, radius, height): in the upright cylinder, at most height "
     "above or below its centre"},
    {.op = Op::kInside, .type = T::kTruth, .asks = S::kPoses, .name = "inside",
     .arguments = {A::kEntity, A::kEntity},
     .meaning = "the centre of the first is in the second's box, or in its ball if it is round"},
    {.op = Op::kNearest, .type = T::kTruth, .asks = S::kOtherPoses, .name = "nearest",
     .arguments = {A::kEntity, A::kEntity},
     .meaning = "of all entities of the first's class, its surface is nearest to the second's "
     "origin"},
    {.op = Op::kPartOf, .type = T::kTruth, .asks = S::kNothing, .name = "part_of",
     .arguments = {A::kEntity, A::kEntity},
     .meaning = "the first is a part of the second, or of a part of it"},
    {.op = Op::kGazed, .type = T::kTruth, .asks = S::kPoses, .name = "gazed",
     .arguments = {A::kEntity, A::kEntity}, .meaning = "the first looks at the second",
     .needs = F::kGazes},
    {.op = Op::kSensorSet, .type = T::kTruth, .asks = S::kTouchValues, .name = "sensor_set",
     .arguments = {A::kHand, A::kSet, A::kThing},
     .meaning = "(hand, set, object): the object touches this sensor set of the hand; a name, or "
     "a number from 1", .needs = F::kSensorSets},
    {.op = Op::kTrigger, .type = T::kNumber, .asks = S::kGrip, .name = "trigger",
     .arguments = {A::kHand}, .meaning = "commanded grip, 0 open .. 1 closed", .range = kShare,
     .measured_as = Both(V::kTrigger), .needs = F::kGrips},
    {.op = Op::kSensorSets, .type = T::kNumber, .asks = S::kTouchValues, .name = "sensor_sets",
     .arguments = {A::kHand, A::kThing},
     .meaning = "how many sensor sets of the hand the object touches", .range = {0, 32, true},
     .measured_as = Both(V::kSensorSets), .needs = F::kSensorSets},
    {.op = Op::kUp, .type = T::kNumber, .asks = S::kTouchValues, .name = "up",
     .arguments = {A::kEntity, A::kEntity},
     .meaning = "cosine between up and the contact normal on the first: 1 held from below, 0 side "
     "by side, -1 not touching", .range = {-1, 1},
     .measured_as = Measured{V::kUpOnFirst, V::kUpOnSecond}, .needs = F::kTouches, .without = -1},
    {.op = Op::kForceBetween, .type = T::kNumber, .asks = S::kTouchValues, .name = "force",
     .arguments = {A::kEntity, A::kEntity}, .meaning = "normal force between them",
     .dimension = kNewtons, .range = kNotNegative, .measured_as = Both(V::kForce),
     .both_ways = true, .needs = F::kForces},
    {.op = Op::kTouchSpeed, .type = T::kNumber, .asks = S::kTouchValues, .name = "touch_speed",
     .arguments = {A::kEntity, A::kEntity},
     .meaning = "how fast, up or down, their surfaces move against each other where they touch",
     .dimension = kMetresPerSecond, .range = kNotNegative, .measured_as = Both(V::kVerticalSpeed),
     .both_ways = true, .needs = F::kTouches},
    {.op = Op::kGap, .type = T::kNumber, .asks = S::kPoses, .name = "gap",
     .arguments = {A::kHand, A::kThing},
     .meaning = "smallest distance from the hand's surface to the object's", .dimension = kMetres,
     .range = kNotNegative, .shared = true},
    {.op = Op::kClearance, .type = T::kNumber, .asks = S::kPoses, .name = "clearance",
     .arguments = {A::kEntity, A::kEntity},
     .meaning = "how far the lowest point of the first is above the top of the second, or of the "
     "part of it that is nearest below or above; endless where the first is beside it",
     .dimension = kMetres, .shared = true},
    {.op = Op::kClosingSpeed, .type = T::kNumber, .asks = S::kOtherPoses, .name = "closing_speed",
     .arguments = {A::kHand, A::kThing},
     .meaning = "how fast the gap shrinks, from one frame to the next",
     .dimension = kMetresPerSecond},
    {.op = Op::kSurfaceSpeed, .type = T::kNumber, .asks = S::kOtherPoses, .name = "surface_speed",
     .arguments = {A::kHand},
     .meaning = "of the fastest piece of the hand's surface, from one frame to the next",
     .dimension = kMetresPerSecond, .range = kNotNegative},
    {.op = Op::kDistance, .type = T::kNumber, .asks = S::kPoses, .name = "distance",
     .arguments = {A::kPosition, A::kPosition}, .meaning = "between two positions",
     .dimension = kMetres, .range = kNotNegative, .both_ways = true},
    {.op = Op::kDistanceAlong, .type = T::kNumber, .asks = S::kPoses, .range = kNotNegative},
    {.op = Op::kHeight, .type = T::kNumber, .asks = S::kPoses, .name = "height",
     .arguments = {A::kPosition}, .meaning = "above the world's origin", .dimension = kMetres},
    {.op = Op::kSpeed, .type = T::kNumber, .asks = S::kPoses, .name = "speed",
     .arguments = {A::kEntity}, .meaning = "of the entity's origin", .dimension = kMetresPerSecond,
     .range = kNotNegative},
    {.op = Op::kSpeedOver, .type = T::kNumber, .asks = S::kPoses, .name = "speed",
     .arguments = {A::kEntity, A::kWindow},
     .meaning = "(a, window): how far the entity's origin gets from half the window before to "
     "half of it after, per time", .dimension = kMetresPerSecond, .range = kNotNegative,
     .shared = true},
    {.op = Op::kRelativeSpeed, .type = T::kNumber, .asks = S::kPoses, .name = "relative_speed",
     .arguments = {A::kEntity, A::kEntity},
     .meaning = "of the first's origin against the point of the second where the first is",
     .dimension = kMetresPerSecond, .range = kNotNegative},
    {.op = Op::kRelativeSpeedOver, .type = T::kNumber, .asks = S::kPoses, .name = "relative_speed",
     .arguments = {A::kEntity, A::kEntity, A::kWindow},
     .meaning = "(a, b, window): how far a's origin gets, as seen from b, from half the window "
     "before to half of it after, per time", .dimension = kMetresPerSecond, .range = kNotNegative,
     .shared = true},
    {.op = Op::kVerticalSpeed, .type = T::kNumber, .asks = S::kPoses, .name = "vertical_speed",
     .arguments = {A::kEntity}, .meaning = "upwards", .dimension = kMetresPerSecond},
    {.op = Op::kRelativeVerticalSpeed, .type = T::kNumber, .asks = S::kPoses,
     .name = "relative_vertical_speed", .arguments = {A::kEntity, A::kEntity},
     .meaning = "upwards, of the first against the point of the second where the first is",
     .dimension = kMetresPerSecond},
    {.op = Op::kSpeedAlong, .type = T::kNumber, .asks = S::kPosesAndTouchValues,
     .name = "speed_along", .arguments = {A::kEntity, A::kEntity},
     .meaning = "how fast the first moves along the second, in the plane in which they touch",
     .dimension = kMetresPerSecond, .range = kNotNegative},
    {.op = Op::kDriftAlong, .type = T::kNumber, .asks = S::kPosesAndTouchValues,
     .name = "drift_along", .arguments = {A::kEntity, A::kEntity, A::kWindow},
     .meaning = "(a, b, window): how far a gets along b, in the plane in which they touch, from "
     "half the window before to half of it after, per time", .dimension = kMetresPerSecond,
     .range = kNotNegative},
    {.op = Op::kTurnRate, .type = T::kNumber, .asks = S::kPoses, .name = "turn_rate",
     .arguments = {A::kEntity, A::kEntity, A::kWindow, A::kLength},
     .meaning = "(a, b, window [, shortest]): how fast the direction in which a moves "
     "horizontally, as seen from b, turns to the left; 0 where a way is shorter than 1 mm, or "
     "than `shortest`", .dimension = kRadiansPerSecond, .left_out_m = 0.001, .shared = true},
    {.op = Op::kTilt, .type = T::kNumber, .asks = S::kPoses, .name = "tilt",
     .arguments = {A::kEntity}, .meaning = "angle between the entity's own z axis and up",
     .dimension = kRadians, .range = {0, std::numbers::pi}, .needs = F::kOrientations},
    {.op = Op::kAligned, .type = T::kNumber, .asks = S::kPoses, .name = "aligned",
     .arguments = {A::kEntity, A::kAxis, A::kEntity, A::kAxis},
     .meaning = "(a, axis, b, axis): the angle between an axis of a, x, y or z, and one of b",
     .dimension = kRadians, .range = {0, std::numbers::pi}, .needs = F::kOrientations},
    {.op = Op::kSpin, .type = T::kNumber, .asks = S::kPoses, .name = "spin",
     .arguments = {A::kEntity, A::kAxis, A::kWindow},
     .meaning = "(a, axis, window): how fast the entity turns about its own axis, x, y or z, from "
     "half the window before to half of it after; to the left, seen from the axis' tip",
     .dimension = kRadiansPerSecond, .needs = F::kOrientations},
    {.op = Op::kRotation, .type = T::kNumber, .asks = S::kNothing, .range = {0, std::numbers::pi}},
    {.op = Op::kTwist, .type = T::kNumber, .asks = S::kNothing,
     .range = {-std::numbers::pi, std::numbers::pi}},
    {.op = Op::kJointFraction, .type = T::kNumber, .asks = S::kPoses, .name = "joint_fraction",
     .arguments = {A::kJointed}, .meaning = "of a moving part, 0 closed .. 1 open",
     .range = kShare},
    {.op = Op::kJointAngle, .type = T::kNumber, .asks = S::kPoses, .name = "joint_angle",
     .arguments = {A::kJointed}, .meaning = "of a part on a hinge", .dimension = kRadians},
    {.op = Op::kJointTravel, .type = T::kNumber, .asks = S::kPoses, .name = "joint_travel",
     .arguments = {A::kJointed}, .meaning = "of a part on a slide", .dimension = kMetres},
    {.op = Op::kWeight, .type = T::kNumber, .asks = S::kNothing, .name = "weight",
     .arguments = {A::kThing}, .meaning = "of the thing; of a fixed one, infinite",
     .dimension = kNewtons, .range = kNotNegative},
    {.op = Op::kStrength, .type = T::kNumber, .asks = S::kNothing, .name = "strength",
     .arguments = {A::kHand}, .meaning = "the weight that the hand can lift", .dimension = kNewtons,
     .range = kNotNegative},
    {.op = Op::kRate, .type = T::kNumber, .asks = S::kPoses, .name = "rate",
     .arguments = {A::kNumber, A::kWindow},
     .meaning = "(value, window): how fast a value grows, from half the window before to half of "
     "it after", .shared = true},
    {.op = Op::kMean, .type = T::kNumber, .asks = S::kPoses, .name = "mean",
     .arguments = {A::kNumber, A::kWindow},
     .meaning = "(value, window): of the frames at most half the window before or after",
     .shared = true, .in_window = true, .is_made = true},
    {.op = Op::kMinimum, .type = T::kNumber, .asks = S::kPoses, .name = "min",
     .arguments = {A::kNumber, A::kWindow},
     .meaning = "(value, window): the smallest of the frames at most half the window before or "
     "after", .shared = true, .in_window = true, .is_made = true},
    {.op = Op::kMaximum, .type = T::kNumber, .asks = S::kPoses, .name = "max",
     .arguments = {A::kNumber, A::kWindow},
     .meaning = "(value, window): the largest of the frames at most half the window before or "
     "after", .shared = true, .in_window = true, .is_made = true},
    {.op = Op::kMedian, .type = T::kNumber, .asks = S::kPoses, .name = "median",
     .arguments = {A::kNumber, A::kWindow},
     .meaning = "(value, window): of the frames at most half the window before or after",
     .shared = true, .in_window = true, .is_made = true},
    {.op = Op::kPosition, .type = T::kPosition, .asks = S::kPoses, .name = "position",
     .arguments = {A::kEntity}, .meaning = "of the entity's origin", .dimension = kMetres},
    {.op = Op::kPositionOn, .type = T::kPosition, .asks = S::kPoses, .name = "position_on",
     .arguments = {A::kEntity, A::kEntity},
     .meaning = "of the first's origin as seen from the second, so that it stays when both move "
     "together", .dimension = kMetres},
    {.op = Op::kOrientationOn, .type = T::kPosition, .asks = S::kPoses, .needs = F::kOrientations},
    {.op = Op::kAhead, .type = T::kPosition, .asks = S::kPoses, .name = "ahead",
     .arguments = {A::kHand, A::kLength}, .meaning = "the point this far in front of the palm",
     .dimension = kMetres},
    {.op = Op::kTouchIn, .type = T::kPosition, .asks = S::kPosesAndTouchValues},
    {.op = Op::kNormalIn, .type = T::kPosition, .asks = S::kPosesAndTouchValues},
    {.op = Op::kAbs, .type = T::kNumber, .asks = S::kNothing, .name = "abs",
     .arguments = {A::kNumber}, .meaning = "the value without its sign", .is_made = true},
    Made(Op::kNumber), Made(Op::kAdd), Made(Op::kSubtract), Made(Op::kMultiply), Made(Op::kDivide),
    Made(Op::kNegate), Made(Op::kAtBegin), Made(Op::kAtEnd), Made(Op::kCount),
};

constexpr OverInterval kOverInterval[] = {
    {"displacement", 1, Op::kDistance, {Now(Op::kPosition), Begun(Op::kPosition)}, kMetres},
    {"displacement", 2, Op::kDistance, {Now(Op::kPositionOn), Begun(Op::kPositionOn)}, kMetres},
    {"displacement_along", 2, Op::kDistanceAlong,
     {Begun(Op::kTouchIn), Begun(Op::kTouchIn, 1), Begun(Op::kNormalIn, 1)}, kMetres, true},
    {"rotation", 1, Op::kRotation, {Now(Op::kOrientationOn), Begun(Op::kOrientationOn)}, kRadians},
    {"rotation", 2, Op::kRotation, {Now(Op::kOrientationOn), Begun(Op::kOrientationOn)}, kRadians},
    {"rotation", 1, Op::kTwist, {Now(Op::kOrientationOn), Begun(Op::kOrientationOn)}, kRadians,
     false, true},
    {"rotation", 2, Op::kTwist, {Now(Op::kOrientationOn), Begun(Op::kOrientationOn)}, kRadians,
     false, true},
    {"rise", 1, Op::kSubtract, {Now(Op::kHeight), Begun(Op::kHeight)}, kMetres},
    {"drop", 1, Op::kSubtract, {Begun(Op::kHeight), Now(Op::kHeight)}, kMetres},
};
// clang-format on

// Where each operator has its row.
constexpr auto kPlaces = [] {
  std::array<std::size_t, kOperators> places = {};
  places.fill(kOperators);
  for (std::size_t i = 0; i < std::size(kTraits); ++i)
    places[static_cast<std::size_t>(kTraits[i].op.value)] = i;
  return places;
}();
static_assert(std::size(kTraits) == kOperators && std::ranges::count(kPlaces, kOperators) == 0,
              "each operator has one row");
#define PREHEND_ASKS(name) &&(RowAt(Op::name).asks != S::kNothing || IsConstant(Op::name))
constexpr const Operator& RowAt(Op op) { return kTraits[kPlaces[static_cast<std::size_t>(op)]]; }
constexpr bool IsConstant(Op op) { return op == Op::kWeight || op == Op::kStrength; }
static_assert(true PREHEND_MEASURED_NUMBERS(PREHEND_ASKS) PREHEND_POSITIONS(PREHEND_ASKS),
              "what is measured asks for something, else nothing wakes who asks for it");

}  // namespace

const Operator& RowOf(Op op) { return RowAt(op); }
std::span<const Operator> Operators() { return kTraits; }
std::span<const OverInterval> SignalsOverIntervals() { return kOverInterval; }

const Operator* FindBuiltin(std::string_view name) {
  for (const Operator& row : kTraits) {
    if (row.name == name && !name.empty()) return &row;
  }
  return nullptr;
}

const Operator* FindBuiltin(std::string_view name, std::size_t arguments) {
  for (const Operator& row : kTraits) {
    if (row.name == name && row.arguments.size() == arguments && !name.empty()) return &row;
  }
  return FindBuiltin(name);
}

}  // namespace prehend::grammar
