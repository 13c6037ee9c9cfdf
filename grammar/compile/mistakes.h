// SPDX-License-Identifier: Apache-2.0
// What is said of a grammar as a whole: all mistakes in order, what nothing uses, and where else a
// name is. Part of the compiler. Tested by tests/grammar/compile/compile_test.cc
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/base/source.h"
#include "grammar/compile/lower.h"

namespace prehend::grammar {

/// A file, read.
struct Source {
  GrammarText text;
  ast::File file;
};

/// By file and line, without what only follows from another mistake.
Diagnostics InOrder(Diagnostics diagnostics, const Symbols& symbols);

/// The grammar of `known` that has an event of this name, "" if none has; of several the one with
/// the shortest name.
std::function<std::string(std::string_view)> WhoDefines(const Includer& includer,
                                                        const std::vector<std::string>& known);

/// In the grammar itself; a library may offer more than one uses.
void WarnOfUnused(const Source& own, const Symbols& symbols, Diagnostics& warnings);

}  // namespace prehend::grammar
