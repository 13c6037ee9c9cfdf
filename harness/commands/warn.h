// SPDX-License-Identifier: Apache-2.0
// Warnings on standard error. Tested by tests/house/command_line_test.cc
#pragma once

#include "grammar/compile.h"
#include "grammar/frame.h"
#include "harness/commands/command.h"

namespace prehend::harness {

/// Prints them; nothing when there are none.
void Warn(const CommandContext& context, const grammar::Diagnostics& warnings);
/// What looks like a mistake in a grammar that is to watch this cast.
void WarnOf(const grammar::Program& program, const grammar::Cast& cast,
            const CommandContext& context);

}  // namespace prehend::harness
