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

}  // namespace prehend::grammar
