// SPDX-License-Identifier: Apache-2.0
// Warnings on standard error. Tested by tests/program/command_line_test.cc
#pragma once

#include "grammar/base/frame.h"
#include "grammar/compile/compile.h"
#include "harness/cli/command.h"

namespace prehend::harness {

/// Prints them; nothing when there are none.
void Warn(const CommandContext& context, const grammar::Diagnostics& warnings);
/// What looks like a mistake in a grammar that is to watch this entity_table.
void WarnOf(const grammar::Program& program, const grammar::EntityTable& entity_table,
            const CommandContext& context);

}  // namespace prehend::harness
