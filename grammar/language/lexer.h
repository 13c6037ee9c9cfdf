// SPDX-License-Identifier: Apache-2.0
// Grammar text -> tokens. Line ends mean nothing; `#` starts a comment.
// Tested by tests/grammar/language/parser_test.cc
#pragma once

#include <string>
#include <vector>

#include "grammar/base/diagnostic.h"
#include "grammar/base/source.h"

namespace prehend::grammar {

struct Token {
  enum class Kind { kName, kNumber, kText, kSymbol, kBad, kEnd };  // kBad: was complained of
  Kind kind = Kind::kEnd;
  std::string text;  ///< of a kText, what is between the quotes
  Place place;
  double number = 0;
};

/// The last token is always kEnd. Text that is too large, binary or not UTF-8 yields one diagnostic
/// and no tokens.
std::vector<Token> Tokenize(const GrammarText& grammar, Diagnostics& diagnostics);

}  // namespace prehend::grammar
