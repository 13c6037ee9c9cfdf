// SPDX-License-Identifier: Apache-2.0
// From a grammar's text to a program, or to diagnostics. Tested by
// tests/grammar/compile/compile_test.cc
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "grammar/base/diagnostic.h"
#include "grammar/base/source.h"

namespace prehend::grammar {

struct Program;  // grammar/program/program.h
struct Source;   // grammar/compile/mistakes.h

struct CompileResult {
  std::shared_ptr<const Program> program;  ///< null when there are errors
  Diagnostics diagnostics;
  Diagnostics warnings;  ///< what is allowed and yet looks like a mistake
};

/// `known` are the names that `use NAME` could ask for: diagnostics suggest the nearest. `use
/// "PATH"` asks the includer for a path relative to the file of the grammar; it ends with
/// ".grammar".
CompileResult Compile(const GrammarText& grammar, const Includer& includer,
                      const Overrides& overrides = {}, const std::vector<std::string>& known = {});

/// Compiles the program's texts again, after this edit of their syntax trees.
using Edit = std::function<void(std::deque<Source>&)>;
CompileResult Recompile(const Program& program, const Edit& edit);

}  // namespace prehend::grammar
