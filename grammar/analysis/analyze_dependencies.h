// SPDX-License-Identifier: Apache-2.0
// Which facts each rule depends on: picks a guard per rule, so that bindings about which nothing is
// true cost nothing, and marks what a rule needs from history. Tested by
// tests/grammar/compile/compile_test.cc
#pragma once

#include "grammar/program/program.h"

namespace prehend::grammar {

/// Fills in what the engine derives from the rules: Program::thresholds, and of each Rule
/// everything from `guard` on.
void ChooseGuards(Program& program);

// Finds signals that several rules ask for, so that the engine computes them once per frame; and
// what can be said of them without computing anything.

/// Gives nodes that have the same value for the same entities the same Node::shared. Only those
/// that cost time: windows, clearances, gaps. Sets Node::window, Node::needs_end and
/// Node::by_itself, too. After lowering.
void ShareValues(Program& program);

}  // namespace prehend::grammar
