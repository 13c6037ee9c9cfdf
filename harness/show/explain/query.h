// SPDX-License-Identifier: Apache-2.0
// What somebody asks to have explained, as typed: "reaching@1.24s", "sliding right_hand milk
// @2.0s", "supported_by(milk, table) @ 900 ms", "sliding object=milk". Plays an episode and
// remembers all of it. Tested by tests/harness/show/explain/explain_test.cc
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grammar/program/program.h"
#include "grammar/replay_monitor.h"
#include "harness/base/base/result.h"
#include "harness/episode/episode/episode.h"

namespace prehend::show {

struct Ask {
  grammar::RuleId rule;
  grammar::Binding entities = grammar::kUnbound;  ///< kNone: whoever
  std::optional<double> time_s;
};

/// Complains about names, classes and times with the place in the text, which is called `option`.
/// Roles come in the order of the rule's head or as role=entity; `any`, or none at all, leaves them
/// open.
Result<Ask> ParseAsk(const std::string& option, const std::string& text,
                     const grammar::Program& program, const grammar::EntityTable& entity_table);

// The bindings of a rule that could be meant where some of its roles are left open.

inline constexpr std::size_t kMaxBindings = 64;

/// Those that were looked at while the episode went on; if there is none, those that could have
/// been. At most kMaxBindings. `wanted`: kNone for whoever.
std::vector<grammar::InstanceId> BindingsThatFit(grammar::ReplayMonitor& past, grammar::RuleId rule,
                                                 const grammar::Binding& wanted);

/// More would take too much memory: at 240 frames per second, seven minutes.
inline constexpr grammar::FrameNumber kMaxFrames = 100'000;

struct Watched {
  std::unique_ptr<grammar::ReplayMonitor> past;
  std::string failure;  ///< empty, or why the simulation ended early
  std::string problem;  ///< empty, or why the grammar cannot watch this; then nothing may be asked
};

/// Calls its argument with every frame of an episode.
using PlayFrames =
    std::function<episode::Episode::End(const std::function<void(const grammar::Frame&)>&)>;

Watched Watch(const std::shared_ptr<const grammar::Program>& program,
              const grammar::EntityTable& entities, const PlayFrames& play);
Watched Watch(episode::Episode& episode);

// How measured values and clauses are written for people: "31 mm", "speed_along(milk, table) >=
// slide_speed". Tested by tests/harness/show/explain/explain_test.cc

// What kind of clause a node of a program is.

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
