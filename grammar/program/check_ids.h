// SPDX-License-Identifier: Apache-2.0
// Whether every number in a compiled program names something of it. Asked once, in every build,
// when a grammar has been compiled: then the engine need not ask at every frame. What it indexes by
// such numbers is checked again in debug builds only (grammar/base/ids.h).
// Tested by tests/grammar/program/check_ids_test.cc
#pragma once

#include "grammar/program/program.h"

namespace prehend::grammar {

/// Throws std::logic_error, which says what is not so, if a rule, node, reference, role, anchor,
/// name or threshold is named that the program does not have, or if a node is among its own
/// arguments.
void CheckIds(const Program& program);

}  // namespace prehend::grammar
