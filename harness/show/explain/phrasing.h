// SPDX-License-Identifier: Apache-2.0
// How measured values and clauses are written for people: "31 mm", "speed_along(milk, table) >=
// slide_speed". Tested by tests/harness/show/explain/explain_test.cc
#pragma once

#include <algorithm>
#include <string>

#include "grammar/program/program.h"
#include "grammar/replay_monitor.h"

namespace prehend::show {

// What kind of clause a node of a program is.
// Tested by tests/harness/show/explain/explain_test.cc

inline bool IsRegion(grammar::Op op) {
  return op == grammar::Op::kInSphere || op == grammar::Op::kSolidInSphere ||
         op == grammar::Op::kInCylinder;
}

/// What stood in the grammar for a node; nothing for those that the compiler added.
inline const grammar::NodeNote& NoteOf(const grammar::Program& program, grammar::NodeId node) {
  static const grammar::NodeNote kNothing;
  return node >= grammar::NodeId(0) && node < program.notes.end_id() ? program.notes[node]
                                                                     : kNothing;
}

/// Whether a value at the interval's begin or end (kAtBegin, kAtEnd) is part of it.
inline bool AsksFor(const grammar::Program& program, grammar::NodeId node, grammar::Op op) {
  if (node == grammar::kNone) return false;
  const grammar::Node& n = program.nodes[node];
  return n.op == op || std::any_of(n.args.begin(), n.args.end(),
                                   [&](grammar::NodeId arg) { return AsksFor(program, arg, op); });
}

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
