// SPDX-License-Identifier: Apache-2.0
// Compile() of grammar/monitor.h for those who know which grammars there are.
// Tested by tests/grammar/compile_test.cc
#pragma once

#include <string>
#include <vector>

#include "grammar/monitor.h"

namespace prehend::grammar {

/// `known`: names that `use NAME` could ask for, to suggest one of them. `use "PATH"` asks the
/// includer for a path as seen from the file of the grammar, like it; it ends with ".grammar".
CompileResult Compile(const GrammarText& grammar, const Includer& includer,
                      const Overrides& overrides, const std::vector<std::string>& known);

}  // namespace prehend::grammar
