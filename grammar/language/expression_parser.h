// SPDX-License-Identifier: Apache-2.0
// Expressions and quantities of the grammar language. Part of the parser.
// Tested by tests/grammar/language/parser_test.cc
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "grammar/language/ast.h"
#include "grammar/language/token_reader.h"

namespace prehend::grammar {

class ExpressionParser : public TokenReader {
 public:
  using TokenReader::TokenReader;

 protected:
  // Loosest operator first.
  ast::Expr ParseExpr() { return ParseChain("or", &ExpressionParser::ParseAnd); }
  ast::Expr ParseSum();
  ast::Expr ParsePostfix();
  ast::Expr ParsePrimary();
  Quantity ParseSignedQuantity();
  /// The dimension of `cm/s`, and of `1/s` when it stands behind a number.
  Dimension ParseDimension(double& si);

  /// `or drop` ends a `during`; `or drop(object) > 2 cm` goes on with it.
  bool AtOrDrop() const { return At("or") && At("drop", 1) && !At("(", 2); }

 private:
  ast::Expr ParseAnd() { return ParseChain("and", &ExpressionParser::ParseEdge); }
  ast::Expr ParseChain(std::string_view word, ast::Expr (ExpressionParser::*operand)());
  ast::Expr ParseEdge();
  ast::Expr ParseNot();
  ast::Expr ParseComparison();
  ast::Expr ParseProduct();
  ast::Expr ParseNegation();
  ast::Expr ParseCall(const Token& name);
  ast::Expr ParseAny(Place place);
  ast::Expr ParseAtLeast();
  void ParseUnit(Quantity& quantity);
  bool AtUnit(std::size_t ahead) const;

  ast::Expr Make(ast::Expr::Kind kind, Place place, std::string text, std::vector<ast::Expr> args);
  [[noreturn]] void FailDeep();
  [[noreturn]] void FailLong();

  /// Guards the stack against `((((((..`.
  struct Nested {
    explicit Nested(ExpressionParser& parser);
    ~Nested() { --parser_.depth_; }
    Nested(const Nested&) = delete;
    Nested& operator=(const Nested&) = delete;
    ExpressionParser& parser_;
  };
  int depth_ = 0;
};

// Laws and heads of the grammar language. Part of the parser. Tested by
// tests/grammar/language/parser_test.cc and tests/grammar/errors.txt

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
