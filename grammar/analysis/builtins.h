// SPDX-License-Identifier: Apache-2.0
// The signals and tests that every grammar knows: names, arguments, units. Their meaning is in
// grammar/values/evaluate.cc and, for users, in docs/grammar-language.md; a test compares the two
// lists. Tested by tests/grammar/values/signals_test.cc
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/program/program.h"

namespace prehend::grammar {

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
  kSet
};

/// Between what and what a number lies, both ends included, SI units.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool whole = false;  ///< it counts something
  bool IsPoint() const { return low == high; }
};

/// What a signal asks a frame for.
enum class Asks : std::uint8_t {
  kNothing,      ///< it does not change while an episode goes on, or is made of its arguments
  kTouching,     ///< whether two entities touch
  kTouchValues,  ///< what is measured where they touch
  kGrip,         ///< how far a hand is closed
  kPoses,        ///< poses, joints and gazes
  kPosesAndTouchValues,
};

/// What a touch or a grip measures of it: as the signal names the two entities, and with them
/// swapped.
using Measured = std::array<Threshold::Value, 2>;

/// A signal: all that the compiler knows about it.
struct Builtin {
  std::string_view name;
  Op op;
  Type type;
  Dimension dimension;  ///< of a number
  std::vector<Argument> arguments;
  std::string_view meaning;  ///< one line for listings
  Asks asks;
  Range range;  ///< of a number: what it can be at all
  std::optional<Measured> measured_as =
      std::nullopt;       ///< if comparing it with a constant gives a threshold
  double left_out_m = 0;  ///< what the last argument is, a length, where it is left out; 0: never
};

std::span<const Builtin> Builtins();

/// Null when there is none. Some names stand for several signals with more or fewer arguments: the
/// first of them.
const Builtin* FindBuiltin(std::string_view name);
/// Likewise, the one with so many arguments, if there is one.
const Builtin* FindBuiltin(std::string_view name, std::size_t arguments);
/// Null for what is written otherwise.
const Builtin* FindBuiltin(Op op);

/// What a node asks a frame for, besides what its arguments do.
Asks AskedBy(Op op);
/// Whether that is what is measured of a touch; of poses. It may be both.
bool AsksTouchValues(Op op);
bool AsksPoses(Op op);
/// Whether its value at a frame is made of a window of time around it: Node::number.
bool HasWindow(Op op);
/// Likewise, of a value that is its argument: a rate, a mean.
bool IsOverWindow(Op op);

}  // namespace prehend::grammar
