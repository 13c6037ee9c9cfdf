// SPDX-License-Identifier: Apache-2.0
// What kind of clause a node of a program is.
// Tested by tests/harness/show/explain/explain_test.cc
#pragma once

#include <algorithm>

#include "grammar/program/program.h"

namespace prehend::show {

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

}  // namespace prehend::show
