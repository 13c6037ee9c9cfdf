// SPDX-License-Identifier: Apache-2.0
// The operators that expressions are made of, and one row for each: all that is known of it before
// an episode. A new one is a name here, a row in grammar/program/operators.cc, and a case in
// grammar/values/evaluate.cc: the compiler names what is missing. For users the signals and tests
// are in docs/grammar-language.md. Tested by tests/grammar/values/signals_test.cc
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include "grammar/base/quantity.h"
#include "grammar/program/thresholds.h"

namespace prehend::grammar {

// All operators, by what they compute; SI units. With a case of each, a switch over one kind has
// the others, too, and the compiler names a new one that it lacks. What a node of some has:
//
//   kHolds, kOwns        whether reference `slot` is true; kOwns: of a rule with AnyRule::one, for
//                        roles[0]
//   kKnown               args[0] is true; in it, a rule is unknown where it is out of sight
//   kBegins, kEnds       args[0] becomes true, false here; of a reference, an interval does
//   kSensorSet           the set named `name`, or without a name the `number`th
//   kDistanceAlong       along roles[1], of the piece of roles[0] that was at args[0] in it and at
//                        args[1] in roles[1], where args[2] is the normal
//   kDriftAlong ..       over `number` seconds around the frame, as all to kMedian; kRate and from
//                        kMean on of args[0]
//   kRotation, kTwist    from args[1] to args[0], orientations; kTwist: about the axis `name`
//   kAligned             axis `name` % 3 of roles[0] against axis `name` / 3 of roles[1]
//   kSpin                about the axis `name` of roles[0], as seen from roles[1] or the world
//   kCount               how many intervals `repeat` has found
//   kAtBegin, kAtEnd     a number or a position: that of anchor `slot` where the interval begins,
//                        of args[0] where it ends
//   kTouchIn, kNormalIn  where roles[0] touches roles[1], and the contact normal there, as seen
//                        from the first or second: `number`
// clang-format off
#define PREHEND_TRUTHS(X)                                                                         \
  X(kAnd) X(kOr) X(kNot) X(kKnown) X(kLess) X(kLessEqual) X(kGreater) X(kGreaterEqual) X(kEqual)            \
  X(kNotEqual) X(kHolds) X(kBegins) X(kEnds) X(kInSphere) X(kSolidInSphere) X(kInCylinder)        \
  X(kInside) X(kNearest) X(kOwns) X(kPartOf) X(kIsA) X(kGazed) X(kSensorSet)
#define PREHEND_MADE_NUMBERS(X)                                                                   \
  X(kNumber) X(kAdd) X(kSubtract) X(kMultiply) X(kDivide) X(kNegate) X(kAbs) X(kDistance)         \
  X(kDistanceAlong) X(kRotation) X(kTwist) X(kSpin) X(kHeight) X(kDriftAlong) X(kTurnRate) X(kRate) X(kSpeedOver)                 \
  X(kRelativeSpeedOver) X(kMean) X(kMinimum) X(kMaximum) X(kMedian) X(kCount)
#define PREHEND_ANCHORED(X) X(kAtBegin) X(kAtEnd)
#define PREHEND_MEASURED_NUMBERS(X)                                                               \
  X(kTrigger) X(kSensorSets) X(kUp) X(kForceBetween) X(kTouchSpeed) X(kGap) X(kClearance)         \
  X(kClosingSpeed) X(kSurfaceSpeed) X(kSpeed) X(kVerticalSpeed) X(kRelativeVerticalSpeed)         \
  X(kRelativeSpeed) X(kSpeedAlong) X(kTilt) X(kAligned) X(kJointFraction) X(kJointAngle) X(kJointTravel)      \
  X(kWeight) X(kStrength)
#define PREHEND_POSITIONS(X) X(kPosition) X(kPositionOn) X(kOrientationOn) X(kAhead) X(kTouchIn) X(kNormalIn)
#define PREHEND_OPERATORS(X)                                                                      \
  PREHEND_TRUTHS(X) PREHEND_MADE_NUMBERS(X) PREHEND_ANCHORED(X) PREHEND_MEASURED_NUMBERS(X)       \
  PREHEND_POSITIONS(X)
#define PREHEND_NAME(name) name,
#define PREHEND_CASE(name) case Op::name:
#define PREHEND_ONE(name) +1
// clang-format on

enum class Op : std::uint8_t { PREHEND_OPERATORS(PREHEND_NAME) };
inline constexpr std::size_t kOperators = PREHEND_OPERATORS(PREHEND_ONE);

inline bool IsComparison(Op op) { return op >= Op::kLess && op <= Op::kNotEqual; }
/// Made of truth values, from frame to frame where it is a moment.
inline bool IsLogic(Op op) { return op <= Op::kKnown || op == Op::kBegins || op == Op::kEnds; }
/// Of a comparison, whether it is true.
inline bool Compares(Op op, double a, double b) {
  return op == Op::kLess           ? a < b
         : op == Op::kLessEqual    ? a <= b
         : op == Op::kGreater      ? a > b
         : op == Op::kGreaterEqual ? a >= b
         : op == Op::kEqual        ? a == b
                                   : a != b;
}
/// Of a sum, difference, product or quotient.
inline double Calculate(Op op, double a, double b) {
  return op == Op::kAdd ? a + b : op == Op::kSubtract ? a - b : op == Op::kMultiply ? a * b : a / b;
}

enum class Type : std::uint8_t { kTruth, kNumber, kPosition };

/// What an argument must be. The first five are roles of that class.
/// A window is a constant span of time; a set is the name of a sensor set, or its number.
enum class Argument : std::uint8_t {
  kEntity,
  kHand,
  kThing,
  kMovable,
  kJointed,
  kPosition,
  kLength,
  kNumber,
  kWindow,
  kSet,
  kAxis  ///< of the role before it: x, y or z
};

/// At most four, so that a table of them is a constant.
class Arguments {
 public:
  constexpr Arguments() = default;
  constexpr Arguments(std::initializer_list<Argument> all) {
    for (const Argument argument : all) all_[size_++] = argument;
  }
  constexpr const Argument* begin() const { return all_.data(); }
  constexpr const Argument* end() const { return all_.data() + size_; }
  constexpr std::size_t size() const { return size_; }
  constexpr Argument operator[](std::size_t i) const { return all_[i]; }
  constexpr bool Has(Argument wanted) const {
    for (const Argument argument : *this) {
      if (argument == wanted) return true;
    }
    return false;
  }

 private:
  std::array<Argument, 4> all_ = {};
  std::size_t size_ = 0;
};

/// Between what and what a number lies, both ends included, SI units.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool whole = false;  ///< it counts something
  bool IsPoint() const { return low == high; }
};

/// What an operator asks a frame for, besides what its arguments do. Only what is asked for wakes
/// an instance.
enum class Asks : std::uint8_t {
  kNothing,      ///< it does not change while an episode goes on, or is made of its arguments
  kTouching,     ///< whether two entities touch
  kTouchValues,  ///< what is measured where they touch
  kGrip,         ///< how far a hand is closed
  kPoses,        ///< poses, joints and gazes of its roles in this frame
  kOtherPoses,   ///< those of another frame or another entity, too: it may change by itself
  kPosesAndTouchValues,
};

/// A kind of facts that an episode may lack.
enum class Fact : std::uint8_t {
  kNoFact,
  kTouches,
  kSensorSets,
  kForces,
  kOrientations,
  kGrips,
  kGazes
};

/// What a touch or a grip measures of it: as the signal names the two entities, and with them
/// swapped.
using Measured = std::array<Threshold::Value, 2>;

/// A column that no row leaves out.
template <typename T>
struct Given {
  constexpr Given(T given) : value(given) {}
  constexpr operator T() const { return value; }
  T value;
};

struct Operator {
  Given<Op> op;
  Given<Type> type;  ///< kAtBegin, kAtEnd: unless it is a position there
  Given<Asks> asks;
  std::string_view name = {};     ///< of a signal or a test that is written as a call
  Arguments arguments = {};       ///< likewise
  std::string_view meaning = {};  ///< likewise: one line for messages
  Dimension dimension = kPlain;   ///< of a number
  Range range = {};               ///< of a number: what it can be at all
  std::optional<Measured> measured_as =
      std::nullopt;        ///< if comparing it with a constant gives a threshold
  double left_out_m = 0;   ///< what the last argument is, a length, where it is left out; 0: never
  bool shared = false;     ///< it costs time: computed once for all rules that ask for it
  bool in_window = false;  ///< of the frames in its window; else of those at its ends
  bool is_made = false;    ///< its range follows from those of its arguments
  bool both_ways = false;  ///< the same with its two arguments swapped
  Fact needs = Fact::kNoFact;
  double without = 0;  ///< what it is where there is no such fact

  /// Its value at a frame is made of a window of time around it: Node::number.
  constexpr bool HasWindow() const { return arguments.Has(Argument::kWindow); }
  /// Likewise, of a value that is its argument: a rate, a mean.
  constexpr bool IsOverWindow() const { return HasWindow() && arguments.Has(Argument::kNumber); }
  /// Whether it may change with time alone, though nothing that it asks for changes.
  constexpr bool ChangesByItself() const { return HasWindow() || asks == Asks::kOtherPoses; }
  constexpr bool AsksTouchValues() const {
    return asks == Asks::kTouchValues || asks == Asks::kPosesAndTouchValues;
  }
  constexpr bool AsksPoses() const {
    return asks == Asks::kPoses || asks == Asks::kOtherPoses || asks == Asks::kPosesAndTouchValues;
  }
  /// Poses, hands or touches of the frame, not only whether two touch.
  constexpr bool IsLook() const { return asks != Asks::kNothing && asks != Asks::kTouching; }
};

const Operator& RowOf(Op op);
/// In the order in which they are listed; those without a name are written otherwise.
std::span<const Operator> Operators();

/// The signal or test of this name, null when there is none. Some names stand for several with more
/// or fewer arguments: the first of them.
const Operator* FindBuiltin(std::string_view name);
/// Likewise, the one with so many arguments, if there is one.
const Operator* FindBuiltin(std::string_view name, std::size_t arguments);

/// A signal that is measured over an interval: an operator of what is so now and was so where the
/// interval began.
struct OverInterval {
  struct Part {
    Op op = Op::kNumber;  ///< of the signal's roles
    bool at_begin = false;
    double number = 0;  ///< Node::number
  };
  std::string_view name;
  std::size_t roles = 0;
  Op op = Op::kDistance;
  std::array<std::optional<Part>, 3> parts;
  Dimension dimension;
  bool looks = false;       ///< the operator looks at the roles itself, too
  bool about_axis = false;  ///< of the first role, named last
};
/// The same name may stand for several, with one role and with two.
std::span<const OverInterval> SignalsOverIntervals();

}  // namespace prehend::grammar
