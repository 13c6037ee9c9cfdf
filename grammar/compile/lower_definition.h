// SPDX-License-Identifier: Apache-2.0
// One definition: its form and modifiers, from the syntax tree into the program. Part of the
// compiler. Tested by tests/grammar/compile/compile_test.cc
#pragma once

#include "grammar/compile/lower.h"

namespace prehend::grammar {

/// Fills in program.rules[index], whose head is there already. Mistakes go to the diagnostics of
/// `lowering`.
void LowerDefinitionInto(Program& program, RuleId index, const ast::Definition& definition,
                         Lowering& lowering);

/// Likewise, the parts and relations of a composition.
void LowerComposition(Program& program, RuleId index, const ast::Definition& definition,
                      Lowering& lowering);

}  // namespace prehend::grammar
