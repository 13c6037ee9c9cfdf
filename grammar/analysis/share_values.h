// SPDX-License-Identifier: Apache-2.0
// Finds signals that several rules ask for, so that the engine computes them once per frame; and
// what can be said of them without computing anything.
#pragma once

#include "grammar/program/program.h"

namespace prehend::grammar {

/// Gives nodes that have the same value for the same entities the same Node::shared. Only those
/// that cost time: windows, clearances, gaps. Sets Node::window, Node::needs_end and
/// Node::by_itself, too. After lowering.
void ShareValues(Program& program);

}  // namespace prehend::grammar
