// SPDX-License-Identifier: Apache-2.0
// One function per level of precedence.
#include "grammar/language/expression_parser.h"

#include <algorithm>
#include <array>

namespace prehend::grammar {

using ast::Expr;

namespace {

constexpr int kMaxDepth = 64;

template <typename... Rest>
std::vector<Expr> Args(Expr first, Rest... rest) {
  std::vector<Expr> args;
  args.push_back(std::move(first));
  (args.push_back(std::move(rest)), ...);
  return args;
}

}  // namespace

ExpressionParser::Nested::Nested(ExpressionParser& parser) : parser_(parser) {
  if (++parser_.depth_ <= kMaxDepth) return;
  --parser_.depth_;
  parser_.FailDeep();
}

void ExpressionParser::FailDeep() {
  Fail("this is nested more than " + std::to_string(kMaxDepth) + " deep",
       "name a part of it with `condition`");
}

// Flat as it is written, but each step takes in what stands before it.
void ExpressionParser::FailLong() {
  Fail("this has more than " + std::to_string(kMaxDepth) + " steps in a row",
       "name a part of it with `define`");
}

Expr ExpressionParser::Make(Expr::Kind kind, Place place, std::string text,
                            std::vector<Expr> args) {
  int depth = 1;
  for (const Expr& arg : args) depth = std::max(depth, arg.depth + 1);
  if (depth > kMaxDepth) FailDeep();
  const bool is_between = kind == Expr::Kind::kBinary || kind == Expr::Kind::kChain ||
                          kind == Expr::Kind::kEdge || kind == Expr::Kind::kAnchor;
  const Place begin = is_between ? args.front().begin : place;
  return {.kind = kind,
          .place = place,
          .text = std::move(text),
          .args = std::move(args),
          .depth = depth,
          .begin = begin,
          .end = End()};
}

Expr ExpressionParser::ParseChain(std::string_view word, Expr (ExpressionParser::*operand)()) {
  Expr first = (this->*operand)();
  if (!At(word) || AtOrDrop()) return first;
  const Place place = Peek().place;
  std::vector<Expr> args = Args(std::move(first));
  while (At(word) && !AtOrDrop()) {
    SkipOne();
    args.push_back((this->*operand)());
  }
  return Make(Expr::Kind::kChain, place, std::string(word), std::move(args));
}

// `not X begins` is the moment from which X is false: `begins` and `ends` take in a `not` before
// them.
Expr ExpressionParser::ParseEdge() {
  Expr expr = ParseNot();
  if (!At("begins") && !At("ends")) return expr;
  const Token word = Take();
  return Make(Expr::Kind::kEdge, word.place, word.text, Args(std::move(expr)));
}

Expr ExpressionParser::ParseNot() {
  const Place place = Peek().place;
  if (!At("not") && !At("known")) return ParseComparison();
  const Nested nested(*this);
  std::string word = Take().text;
  return Make(Expr::Kind::kUnary, place, std::move(word), Args(ParseNot()));
}

Expr ExpressionParser::ParseComparison() {
  static constexpr std::array<std::string_view, 6> kComparisons = {
      "<=", ">=", "==", "!=", "<", ">"};
  Expr left = ParseSum();
  if (std::none_of(kComparisons.begin(), kComparisons.end(),
                   [&](std::string_view op) { return At(op); }))
    return left;
  const Token op = Take();
  return Make(Expr::Kind::kBinary, op.place, op.text, Args(std::move(left), ParseSum()));
}

Expr ExpressionParser::ParseSum() {
  Expr left = ParseProduct();
  while (At("+") || At("-")) {
    const Token op = Take();
    if (left.depth >= kMaxDepth) FailLong();
    left = Make(Expr::Kind::kBinary, op.place, op.text, Args(std::move(left), ParseProduct()));
  }
  return left;
}

Expr ExpressionParser::ParseProduct() {
  Expr left = ParseNegation();
  while (At("*") || At("/")) {
    const Token op = Take();
    if (left.depth >= kMaxDepth) FailLong();
    left = Make(Expr::Kind::kBinary, op.place, op.text, Args(std::move(left), ParseNegation()));
  }
  return left;
}

Expr ExpressionParser::ParseNegation() {
  const Place place = Peek().place;
  if (!Accept("-")) return ParsePostfix();
  const Nested nested(*this);
  return Make(Expr::Kind::kUnary, place, "-", Args(ParseNegation()));
}

Expr ExpressionParser::ParsePostfix() {
  Expr expr = ParsePrimary();
  while (At("@")) {
    const Place place = Take().place;
    if (!At("begin") && !At("end")) Fail("expected 'begin' or 'end' after '@', found " + Found());
    expr = Make(Expr::Kind::kAnchor, place, Take().text, Args(std::move(expr)));
  }
  return expr;
}

Expr ExpressionParser::ParsePrimary() {
  const Nested nested(*this);
  const Token token = Peek();
  if (token.kind == Token::Kind::kNumber) {
    Expr expr = Make(Expr::Kind::kQuantity, token.place, token.text, {});
    expr.quantity = ParseSignedQuantity();
    expr.end = End();
    return expr;
  }
  if (token.kind == Token::Kind::kText)
    return Make(Expr::Kind::kText, token.place, Take().text, {});
  if (Accept("(")) {
    Expr inner = ParseExpr();
    ExpectToClose(token);
    inner.begin = token.place;
    inner.end = End();
    return inner;
  }
  if (Accept("any")) return ParseAny(token.place);
  if (At("at") && Peek(1).text == "least") return ParseAtLeast();
  std::string name = ExpectName("a condition, a signal or a value");
  if (At("(")) return ParseCall(token);
  return Make(Expr::Kind::kName, token.place, std::move(name), {});
}

// `at least 3 of grasping(hand, any)`.
Expr ExpressionParser::ParseAtLeast() {
  const Place place = Take().place;
  SkipOne();
  Expr number = ParsePostfix();
  if (!Accept("of"))
    Fail("expected 'of' after 'at least' and a number, found " + Found(),
         "for example: at least 3 of grasping(hand, any)");
  Expr call = ParsePrimary();
  return Make(Expr::Kind::kCall, place, ast::kAtLeast, Args(std::move(number), std::move(call)));
}

// `any`, `any Cup`.
Expr ExpressionParser::ParseAny(Place place) {
  std::vector<Expr> args;
  if (Peek().kind == Token::Kind::kName && !IsReserved(Peek().text)) {
    const Token name = Take();
    args = Args(Make(Expr::Kind::kName, name.place, name.text, {}));
  }
  return Make(Expr::Kind::kName, place, "any", std::move(args));
}

Expr ExpressionParser::ParseCall(const Token& name) {
  const Token bracket = Take();
  std::vector<Expr> args;
  if (!At(")")) {
    do {
      args.push_back(ParseExpr());
    } while (Accept(","));
  }
  ExpectToClose(bracket);
  return Make(Expr::Kind::kCall, name.place, name.text, std::move(args));
}

Quantity ExpressionParser::ParseSignedQuantity() {
  const bool negative = Accept("-");
  if (Peek().kind != Token::Kind::kNumber) Fail("expected a number, found " + Found());
  const Token token = Take();
  Quantity quantity{negative ? -token.number : token.number, kPlain};
  ParseUnit(quantity);
  return quantity;
}

bool ExpressionParser::AtUnit(std::size_t ahead) const {
  return Peek(ahead).kind == Token::Kind::kName && FindUnit(Peek(ahead).text) != nullptr;
}

// `3 cm`, `3 cm/s`, `3/s`. A name after a number can only be a unit or the next word of the
// language, also `one hand per object` and `gap at most`.
void ExpressionParser::ParseUnit(Quantity& quantity) {
  const bool is_one_per = At("one") && Peek(1).kind == Token::Kind::kName;
  const bool starts = Peek().kind == Token::Kind::kName && !IsReserved(Peek().text) &&
                      Peek().text != "gap" && !is_one_per && (AtUnit(0) || !BeginsLine());
  if (!starts && !(At("/") && AtUnit(1))) return;
  double si = 1;
  quantity.dimension = ParseDimension(si);
  quantity.value = AsWritten(quantity.value * si);
}

Dimension ExpressionParser::ParseDimension(double& si) {
  Dimension dimension;
  if (Peek().kind == Token::Kind::kName) {
    const Unit* unit = FindUnit(Peek().text);
    if (unit == nullptr) {
      std::string near = NearestName(Peek().text, UnitNames());
      for (const std::string_view angle : {"deg", "rad"})
        if (Peek().text.starts_with(angle)) near = angle;
      if (Peek().text.starts_with("sec")) near = "s";
      const std::string message = "unknown unit '" + Peek().text + "'";
      if (!near.empty()) FailAt(Peek().place, message, "did you mean '" + near + "'?");
      Fail(message, "units are m cm mm s ms N rad deg, and their quotients like cm/s");
    }
    SkipOne();
    si = unit->si;
    dimension = unit->dimension;
  }
  constexpr int kMostDivisors = 8;
  for (int divisors = 0; At("/") && AtUnit(1); ++divisors) {
    if (divisors == kMostDivisors)
      Fail("a unit with more than " + std::to_string(kMostDivisors) + " divisors");
    SkipOne();
    const Unit* divisor = FindUnit(Take().text);
    si /= divisor->si;
    dimension = Quotient(dimension, divisor->dimension);
  }
  return dimension;
}

// The three forms of a law: `rest of .. is empty`, `.. do not overlap`, and relations of intervals.

using ast::Law;

std::vector<ast::Role> LawParser::ParseRoles(std::string hint) {
  std::vector<ast::Role> roles;
  const Token bracket = Peek();
  Expect("(", std::move(hint));
  do {
    const Place place = Peek().place;
    std::string name = ExpectName("a role's name");
    Expect(":", "every role has a class: object: Movable");
    roles.push_back({std::move(name), ExpectName("a class"), place});
  } while (Accept(","));
  ExpectToClose(bracket);
  return roles;
}

Law LawParser::ParseLaw() {
  Law law;
  law.place = Peek().place;
  law.name = ExpectName("the name of a law");
  law.roles =
      ParseRoles("a law lists its roles: law slides_are_supported(hand: Hand, object: Movable)");
  if (Accept("rest")) {
    ParseCovered(law);
    return law;
  }
  do {
    law.subjects.push_back(ParsePostfix());
  } while (Accept(","));
  if (!Accept("do")) {
    ParseRelated(law);
    return law;
  }
  law.form = Law::Form::kApart;
  Expect("not", "what never happens at the same time: a(x), b(x) do not overlap");
  Expect("overlap", "what never happens at the same time: a(x), b(x) do not overlap");
  return law;
}

// The words `is`, `empty`, `do`, `overlap`, `lie` and `lies` can be names elsewhere: an expression
// never goes on with a name.
void LawParser::ParseCovered(Law& law) {
  constexpr const char* kHint = "say that nothing is left: rest of a(x) outside b(x) is empty";
  law.form = Law::Form::kCovered;
  Expect("of");
  law.subjects.push_back(ParsePostfix());
  Expect("outside");
  do {
    law.others.push_back(ParsePostfix());
  } while (Accept(","));
  Expect("is", kHint);
  Expect("empty", kHint);
}

void LawParser::ParseRelated(Law& law) {
  law.form = Law::Form::kRelated;
  law.relations_place = Peek().place;
  if (Accept("lies") || Accept("lie")) {
    Expect("inside", "a(x) lies inside b(x)");
    law.relations = {"lies inside"};
  } else {
    ParseRelations(law);
  }
  do {
    law.others.push_back(ParsePostfix());
  } while (Accept("or"));
}

void LawParser::ParseRelations(Law& law) {
  do {
    if (At("during"))
      Fail("expected one of Allen's relations, found 'during'",
           "with both ends in it, that is 'lies inside': a(x) lies inside b(x)");
    if (Peek().kind != Token::Kind::kName)
      Fail("expected 'do not overlap', 'lies inside' or one of Allen's relations, found " + Found(),
           "a law says how events lie to each other: a(x) meets b(x)");
    const Place place = Peek().place;
    law.relations.push_back(ExpectName("one of Allen's relations"));
    if (At("("))
      FailAt(place,
             "expected 'do not overlap', 'lies inside' or one of Allen's relations, found '" +
                 law.relations.back() + "'",
             "a law says how events lie to each other: a(x) meets b(x)");
  } while (Accept("|"));
}

}  // namespace prehend::grammar
