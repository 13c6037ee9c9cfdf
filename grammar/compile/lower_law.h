// SPDX-License-Identifier: Apache-2.0
// One law of a grammar, looked up and checked. Tested by tests/grammar/errors.txt and
// tests/grammar/check_laws_test.cc
#pragma once

#include "grammar/compile/lower.h"

namespace prehend::grammar {

/// Needs the heads of all rules. Nothing after an error, which is appended to `diagnostics`.
std::optional<Law> LowerLaw(Symbols& symbols, const GrammarText& source, const ast::Law& law,
                            Diagnostics& diagnostics);

}  // namespace prehend::grammar
