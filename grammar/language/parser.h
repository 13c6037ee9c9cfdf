// SPDX-License-Identifier: Apache-2.0
// Grammar text -> syntax tree, by recursive descent. After an error it goes on at the next
// definition, so that one reading reports several mistakes. The syntax is the EBNF in
// docs/grammar-language.md. Tested by tests/grammar/language/parser_test.cc
#pragma once

#include <optional>
#include <string>

#include "grammar/base/source.h"
#include "grammar/language/ast.h"

namespace prehend::grammar {

ast::File Parse(const GrammarText& grammar, Diagnostics& diagnostics);

/// A value as on the right of `param x =`: "25 cm". Errors are reported at their place in `text`.
std::optional<Quantity> ParseQuantity(const GrammarText& text, Diagnostics& diagnostics);

// A grammar's text, laid out as the library's: one blank between tokens, clauses indented, comments
// and line breaks kept. Tested by tests/grammar/language/format_test.cc

/// Another text of the same meaning; of text that cannot be read as tokens, the text as it is.
std::string FormatText(const GrammarText& grammar);

}  // namespace prehend::grammar
