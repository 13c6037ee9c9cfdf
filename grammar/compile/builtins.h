// SPDX-License-Identifier: Apache-2.0
// The signals and tests that every grammar knows: names, arguments, units. Their meaning is in
// grammar/engine/evaluate.cc and, for users, in docs/grammar-language.md; a test compares the two
// lists. Tested by tests/grammar/engine/signals_test.cc
#pragma once

#include <limits>
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

struct Builtin {
  std::string_view name;
  Op op;
  Type type;
  Dimension dimension;  ///< of a number
  std::vector<Argument> arguments;
  std::string_view meaning;  ///< one line for listings
  Range range = {};          ///< of a number: what it can be at all
  double left_out_m = 0;  ///< what the last argument is, a length, where it is left out; 0: never
};

std::span<const Builtin> Builtins();

/// Null when there is none.
const Builtin* FindBuiltin(std::string_view name);
/// Null for what is written otherwise.
const Builtin* FindBuiltin(Op op);

}  // namespace prehend::grammar
