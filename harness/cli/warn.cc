// SPDX-License-Identifier: Apache-2.0
#include "harness/cli/warn.h"

#include "harness/run/load_grammar.h"

namespace prehend::harness {

void Warn(const CommandContext& context, const grammar::Diagnostics& warnings) {
  if (!warnings.empty()) context.err << Format(warnings);
}

void WarnOf(const grammar::Program& program, const grammar::EntityTable& entity_table,
            const CommandContext& context) {
  Warn(context, Warnings(program, entity_table));
}

}  // namespace prehend::harness
