// SPDX-License-Identifier: Apache-2.0
// How measured values and clauses are written for people: "31 mm", "speed_along(milk, table) >=
// slide_speed". Tested by tests/harness/show/explain/explain_test.cc
#pragma once

#include <string>

#include "grammar/replay_monitor.h"

namespace prehend::show {

/// In the unit that reads best, three significant digits, more if asked for: "31 mm", "1.5 m/s",
/// "28.6 deg", "2".
std::string QuantityText(double value, const grammar::Dimension& dimension, int digits = 3);

/// Two values that differ are written so that they can be told apart.
struct ValueTexts {
  std::string value;
  std::string limit;
};
ValueTexts Compared(double value, double limit, const grammar::Dimension& dimension);

/// "1.2400 s"
std::string At(grammar::Tick tick, grammar::Tick ticks_per_second);
/// "0.0500 s", or "50 ms"
std::string Duration(grammar::Tick ticks, grammar::Tick ticks_per_second);

/// "grasping(right_hand, milk)"; of a rule made for an `any`: "supported_by(milk, any)".
std::string Label(grammar::ReplayMonitor& past, grammar::InstanceId instance);
/// The rule of the binding, as the grammar calls it.
const std::string& RuleName(grammar::ReplayMonitor& past, grammar::InstanceId instance);
/// "pick_and_place.grammar:42"
std::string Source(const std::string& file, const grammar::Place& place);

/// What stood in the grammar for a node, with the entities' names for the roles.
std::string ClauseText(grammar::ReplayMonitor& past, grammar::InstanceId instance,
                       grammar::NodeId node);

}  // namespace prehend::show
