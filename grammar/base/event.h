// SPDX-License-Identifier: Apache-2.0
// One recognised event as a monitor reports it: numbers only, names are in the program.
// Tested by tests/grammar/monitor_test.cc
#pragma once

#include <array>

#include "grammar/base/frame.h"
#include "grammar/base/ids.h"

namespace prehend::grammar {

inline constexpr int kMaxRoles = 4;
inline constexpr int kMaxAttributes = 4;

/// One recognised event. Names are in Program::rules[rule].
struct Event {
  RuleId rule;
  std::array<int, kMaxRoles> roles = {kNoEntity, kNoEntity, kNoEntity, kNoEntity};  ///< entity ids
  Interval interval;
  Tick decided = 0;       ///< the tick of the frame at which it became certain
  int style = kNoEntity;  ///< value of `with style = style(hand)`, index into EntityTable::styles
  bool open_end = false;  ///< closed by Finish(), not by what happened
  /// Values of `with name = value`, SI units, in the order of Program::rules[rule].attributes.
  std::array<double, kMaxAttributes> attributes = {};
};

}  // namespace prehend::grammar
