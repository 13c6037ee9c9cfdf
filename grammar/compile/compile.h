// SPDX-License-Identifier: Apache-2.0
// From a grammar's text to a program, or to diagnostics. Tested by
// tests/grammar/compile/compile_test.cc
#pragma once

#include <deque>
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

/// The program's texts, read again.
std::deque<Source> SourcesOf(const Program& program);
/// Compiles what became of them.
CompileResult Recompile(const Program& program, std::deque<Source>& sources);

}  // namespace prehend::grammar
