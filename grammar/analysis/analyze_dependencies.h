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

// What nobody sees may happen: `from A without B` and `without X between` claim that something did
// not, so they ask for the sight of it.

/// Adds to each absence that what it names is tracked all the time, as far as poses show it: those
/// of the roles that B or X is about, also through the rules that they use. What is meant by `any`
/// is not named. After the rules are ordered, before ChooseGuards().
void RequireSight(Program& program);

}  // namespace prehend::grammar
