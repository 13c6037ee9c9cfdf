// SPDX-License-Identifier: Apache-2.0
// Laws and heads of the grammar language. Part of the parser. Tested by
// tests/grammar/language/parser_test.cc and tests/grammar/errors.txt
#pragma once

#include <string>
#include <vector>

#include "grammar/language/ast.h"
#include "grammar/language/expression_parser.h"

namespace prehend::grammar {

class LawParser : public ExpressionParser {
 public:
  using ExpressionParser::ExpressionParser;

 protected:
  /// What follows the word `law`.
  ast::Law ParseLaw();
  /// `(hand: Hand, object: Thing)`; the hint says what the brackets are for.
  std::vector<ast::Role> ParseRoles(std::string hint);

 private:
  void ParseCovered(ast::Law& law);
  void ParseRelated(ast::Law& law);
  void ParseRelations(ast::Law& law);
};

}  // namespace prehend::grammar
