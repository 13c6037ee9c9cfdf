// SPDX-License-Identifier: Apache-2.0
#include "harness/commands/warn.h"

#include "harness/load_grammar.h"

namespace prehend::harness {

void Warn(const CommandContext& context, const grammar::Diagnostics& warnings) {
  if (!warnings.empty()) context.err << Format(warnings);
}

void WarnOf(const grammar::Program& program, const grammar::Cast& cast,
            const CommandContext& context) {
  Warn(context, Warnings(program, cast));
}

}  // namespace prehend::harness
