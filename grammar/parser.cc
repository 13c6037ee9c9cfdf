// SPDX-License-Identifier: Apache-2.0
#include "grammar/parser.h"

#include <algorithm>
#include <array>

#include "grammar/lexer.h"

namespace prehend::grammar {
namespace {

using ast::Definition;
using ast::Expr;

constexpr int kMaxDepth = 64;
constexpr std::size_t kMaxDefinitions = 1000;

constexpr std::array<std::string_view, 6> kItemWords = {"grammar", "use", "param", "condition", "event", "symmetric"};
constexpr std::array<std::string_view, 32> kOtherWords = {
    "while",    "from", "to",   "during", "until",    "since",    "at",       "most",   "back", "rest",
    "of",       "outside",      "compose", "where",      "bridging", "lasting",  "requires", "confirmed", "by",
    "within",   "with", "approaching", "receding", "slower", "than", "begins",   "ends",     "and",    "or",   "not",
    "any",      "style"};

// Thrown inside this file only: unwinds to the next definition after the complaint was written down.
struct Stop {};

class Parser {
 public:
  Parser(const GrammarText& grammar, Diagnostics& diagnostics)
      : grammar_(grammar), diagnostics_(diagnostics), tokens_(Tokenize(grammar, diagnostics)) {}

  ast::File ParseFile() {
    ast::File file;
    try {
      if (AtEnd()) Fail("the file is empty", "a grammar starts with `grammar NAME`");
      Expect("grammar", "a grammar starts with `grammar NAME`");
      file.name = ExpectName("the grammar's name");
    } catch (const Stop&) {
      SkipToItem();
    }
    while (!AtEnd()) {
      try {
        ParseItem(file);
      } catch (const Stop&) {
        SkipToItem();
      }
    }
    return file;
  }

  std::optional<Quantity> ParseOnlyQuantity() {
    try {
      const Quantity quantity = ParseSignedQuantity();
      if (!AtEnd()) Fail("expected nothing after the value, found " + Found());
      return quantity;
    } catch (const Stop&) {
      return std::nullopt;
    }
  }

 private:
  // Tokens.
  const Token& Peek(std::size_t ahead = 0) const { return tokens_[std::min(at_ + ahead, tokens_.size() - 1)]; }
  bool AtEnd() const { return Peek().kind == Token::Kind::kEnd; }
  bool At(std::string_view text, std::size_t ahead = 0) const {
    return Peek(ahead).kind != Token::Kind::kEnd && Peek(ahead).text == text;
  }
  Token Take() {
    Token token = Peek();
    if (!AtEnd()) ++at_;
    return token;
  }
  bool Accept(std::string_view text) {
    if (!At(text)) return false;
    ++at_;
    return true;
  }
  std::string Found() const { return AtEnd() ? "the end of the file" : "'" + Peek().text + "'"; }

  [[noreturn]] void Fail(std::string message, std::string hint = {}) { FailAt(Peek().place, std::move(message), std::move(hint)); }
  [[noreturn]] void FailAt(Place place, std::string message, std::string hint = {}) {
    diagnostics_.push_back(DiagnosticAt(grammar_.file, grammar_.text, place, std::move(message), std::move(hint)));
    throw Stop{};
  }
  void Expect(std::string_view text, std::string hint = {}) {
    if (!Accept(text)) Fail("expected '" + std::string(text) + "', found " + Found(), std::move(hint));
  }
  std::string ExpectName(std::string_view what) {
    if (Peek().kind != Token::Kind::kName) Fail("expected " + std::string(what) + ", found " + Found());
    if (IsReserved(Peek().text)) {
      Fail("'" + Peek().text + "' is a word of the language and cannot be " + std::string(what), "choose another name");
    }
    return Take().text;
  }

  void SkipToItem() {
    while (!AtEnd() && std::find(kItemWords.begin(), kItemWords.end(), Peek().text) == kItemWords.end()) ++at_;
  }

  // Items.
  void ParseItem(ast::File& file) {
    const Place place = Peek().place;
    if (Accept("use")) {
      file.uses.push_back({ExpectName("a grammar's name"), place});
    } else if (Accept("param")) {
      const Place name_place = Peek().place;
      std::string name = ExpectName("a parameter's name");
      Expect("=");
      file.params.push_back({std::move(name), name_place, ParseSignedQuantity()});
    } else if (At("event") || At("condition") || At("symmetric")) {
      if (file.definitions.size() == kMaxDefinitions) {
        at_ = tokens_.size() - 1;
        FailAt(place, "more than " + std::to_string(kMaxDefinitions) + " definitions in one file");
      }
      file.definitions.push_back(ParseDefinition());
    } else if (At("grammar")) {
      ++at_;
      FailAt(place, "a second 'grammar' line", "one file holds one grammar; `use NAME` reads another one");
    } else {
      Fail("expected 'use', 'param', 'condition' or 'event', found " + Found(), NearestHint());
    }
  }

  std::string NearestHint() const {
    std::vector<std::string> words(kItemWords.begin(), kItemWords.end());
    words.insert(words.end(), kOtherWords.begin(), kOtherWords.end());
    const std::string near = NearestName(Peek().text, words);
    return near.empty() || near == Peek().text ? std::string() : "did you mean '" + near + "'?";
  }

  Definition ParseDefinition() {
    Definition definition;
    definition.symmetric = Accept("symmetric");
    definition.is_event = !At("condition");
    if (definition.symmetric || !At("condition")) Expect("event");
    else ++at_;
    definition.place = Peek().place;
    definition.name = ExpectName("the name of an event or condition");
    ParseRoles(definition);
    ParseForm(definition);
    while (ParseModifier(definition)) {
    }
    return definition;
  }

  void ParseRoles(Definition& definition) {
    Expect("(", "an event names who takes part: event grasping(hand: Hand, object: Thing)");
    do {
      const Place place = Peek().place;
      std::string name = ExpectName("a role's name");
      Expect(":", "every role has a class: object: Movable");
      definition.roles.push_back({std::move(name), ExpectName("a class"), place});
    } while (Accept(","));
    Expect(")");
  }

  void ParseForm(Definition& definition) {
    if (Accept("while")) {
      definition.form = Definition::Form::kWhile;
      definition.first = ParseExpr();
    } else if (Accept("from")) {
      definition.form = Definition::Form::kFromTo;
      definition.first = ParseExpr();
      Expect("to");
      definition.second = ParseExpr();
      if (Accept("during")) {
        definition.during = ParseExpr();
        definition.or_drop = AtOrDrop();
        if (definition.or_drop) at_ += 2;
      }
    } else if (Accept("until")) {
      ParseUntil(definition);
    } else if (Accept("rest")) {
      definition.form = Definition::Form::kRestOf;
      Expect("of");
      definition.first = ParsePostfix();
      Expect("outside");
      do {
        definition.outside.push_back(ParsePostfix());
      } while (Accept(","));
    } else if (Accept("compose")) {
      ParseCompose(definition);
    } else {
      Fail("expected 'while', 'from', 'until', 'rest' or 'compose', found " + Found(), NearestHint());
    }
  }

  // `or drop` ends a `during`; `or drop(object) > 2 cm` goes on with it.
  bool AtOrDrop() const { return At("or") && At("drop", 1) && !At("(", 2); }

  void ParseUntil(Definition& definition) {
    definition.form = Definition::Form::kUntilSince;
    definition.first = ParseExpr();
    Expect("since");
    definition.second = ParseExpr();
    if (Accept("approaching")) {
      ast::Approach approach;
      approach.signal = ParseSum();
      Expect("receding");
      ExpectAtMost();
      approach.slack = ParseSum();
      Accept(",");
      if (Accept("with")) {
        approach.motion = ParseSum();
        if (!At("slower")) Fail("expected 'slower', found " + Found(), "with surface_speed(hand, object) slower than 1 cm/s");
      }
      if (Accept("slower")) {
        Expect("than");
        approach.speed = ParseSum();
        ExpectAtMost();
        approach.idle = ParseSum();
      }
      definition.approach = std::move(approach);
    }
    if (!At("at")) Fail("expected 'at most .. back', found " + Found(), "say how far back to look: at most 10 s back");
    ExpectAtMost();
    definition.at_most_back = ParseSum();
    Expect("back");
  }

  void ExpectAtMost() {
    Expect("at");
    Expect("most");
  }

  void ParseCompose(Definition& definition) {
    definition.form = Definition::Form::kCompose;
    do {
      const Place place = Peek().place;
      std::string label = ExpectName("a label");
      Expect(":", "a composition labels its parts: compose reach: reaching(hand, object), ...");
      definition.parts.push_back({std::move(label), place, ParsePostfix()});
    } while (Accept(","));
    Expect("where", "say how the parts follow each other: where reach before|meets grasp, ...");
    do {
      ast::Relation relation;
      relation.place = Peek().place;
      relation.left = ExpectName("a label");
      do {
        relation.relations.push_back(ExpectName("one of Allen's relations"));
      } while (Accept("|"));
      relation.right = ExpectName("a label");
      definition.relations.push_back(std::move(relation));
    } while (Accept(","));
  }

  template <typename T>
  void Once(std::optional<T>& slot, T value, const Token& word) {
    if (slot) FailAt(word.place, "a second '" + word.text + "' in one definition", "keep one of the two");
    slot = std::move(value);
  }

  bool ParseModifier(Definition& definition) {
    const Token word = Peek();
    if (Accept("bridging")) {
      Once(definition.bridging, ParseSum(), word);
    } else if (Accept("lasting")) {
      Once(definition.lasting, ParseSum(), word);
    } else if (Accept("requires")) {
      Once(definition.requirement, ParseExpr(), word);
    } else if (Accept("confirmed")) {
      Expect("by");
      ast::Confirmation confirmation;
      confirmation.by = ParsePostfix();
      Expect("within", "say how long to wait: confirmed by grasping(hand, object) within contact(hand, object)");
      confirmation.within = ParsePostfix();
      Once(definition.confirmed, std::move(confirmation), word);
    } else if (Accept("with")) {
      Expect("style", "the one attribute so far is: with style = style(hand)");
      Expect("=");
      Expect("style");
      Expect("(");
      Expr role = ParsePrimary();
      Expect(")");
      Once(definition.style, std::move(role), word);
    } else {
      return false;
    }
    return true;
  }

  // Expressions, loosest operator first.
  Expr ParseExpr() { return ParseChain("or", &Parser::ParseAnd); }
  Expr ParseAnd() { return ParseChain("and", &Parser::ParseEdge); }

  Expr ParseChain(std::string_view word, Expr (Parser::*operand)()) {
    Expr first = (this->*operand)();
    if (!At(word) || AtOrDrop()) return first;
    std::vector<Expr> args;
    const Place place = Peek().place;
    args.push_back(std::move(first));
    while (At(word) && !AtOrDrop()) {
      ++at_;
      args.push_back((this->*operand)());
    }
    return Make(Expr::Kind::kChain, place, std::string(word), std::move(args));
  }

  // `not X begins` is the moment from which X is false: `begins` and `ends` take in a `not` before them.
  Expr ParseEdge() {
    Expr expr = ParseNot();
    if (At("begins") || At("ends")) {
      const Token word = Take();
      return Make(Expr::Kind::kEdge, word.place, word.text, Args(std::move(expr)));
    }
    return expr;
  }

  Expr ParseNot() {
    const Place place = Peek().place;
    if (!Accept("not")) return ParseComparison();
    const Nested nested(*this);
    return Make(Expr::Kind::kUnary, place, "not", Args(ParseNot()));
  }

  Expr ParseComparison() {
    static constexpr std::array<std::string_view, 6> kComparisons = {"<=", ">=", "==", "!=", "<", ">"};
    Expr left = ParseSum();
    if (std::find(kComparisons.begin(), kComparisons.end(), Peek().text) == kComparisons.end()) return left;
    const Token op = Take();
    return Make(Expr::Kind::kBinary, op.place, op.text, Args(std::move(left), ParseSum()));
  }

  Expr ParseSum() {
    Expr left = ParseProduct();
    while (At("+") || At("-")) {
      const Token op = Take();
      left = Make(Expr::Kind::kBinary, op.place, op.text, Args(std::move(left), ParseProduct()));
    }
    return left;
  }

  Expr ParseProduct() {
    Expr left = ParseNegation();
    while (At("*") || At("/")) {
      const Token op = Take();
      left = Make(Expr::Kind::kBinary, op.place, op.text, Args(std::move(left), ParseNegation()));
    }
    return left;
  }

  Expr ParseNegation() {
    const Place place = Peek().place;
    if (!Accept("-")) return ParsePostfix();
    const Nested nested(*this);
    return Make(Expr::Kind::kUnary, place, "-", Args(ParseNegation()));
  }

  Expr ParsePostfix() {
    Expr expr = ParsePrimary();
    while (At("@")) {
      const Place place = Take().place;
      if (!At("begin") && !At("end")) Fail("expected 'begin' or 'end' after '@', found " + Found());
      expr = Make(Expr::Kind::kAnchor, place, Take().text, Args(std::move(expr)));
    }
    return expr;
  }

  Expr ParsePrimary() {
    const Nested nested(*this);
    const Token token = Peek();
    if (token.kind == Token::Kind::kNumber) {
      Expr expr = Make(Expr::Kind::kQuantity, token.place, token.text, {});
      expr.quantity = ParseSignedQuantity();
      return expr;
    }
    if (Accept("(")) {
      Expr inner = ParseExpr();
      Expect(")");
      return inner;
    }
    if (Accept("any")) return Make(Expr::Kind::kName, token.place, "any", {});
    // `style` is a word only because of `with style = ..`.
    std::string name = ExpectName("a condition, a signal or a value");
    if (!Accept("(")) return Make(Expr::Kind::kName, token.place, std::move(name), {});
    std::vector<Expr> args;
    if (!At(")")) {
      do {
        args.push_back(ParseExpr());
      } while (Accept(","));
    }
    Expect(")");
    return Make(Expr::Kind::kCall, token.place, std::move(name), std::move(args));
  }

  Quantity ParseSignedQuantity() {
    const bool negative = Accept("-");
    if (Peek().kind != Token::Kind::kNumber) Fail("expected a number, found " + Found());
    const Token token = Take();
    Quantity quantity{negative ? -token.number : token.number, kPlain};
    if (Peek().kind == Token::Kind::kName) ParseUnit(quantity);
    return quantity;
  }

  // `cm`, `cm/s`. A name after a number can only be a unit or the next word of the language.
  void ParseUnit(Quantity& quantity) {
    const Unit* unit = FindUnit(Peek().text);
    if (unit == nullptr) {
      if (IsReserved(Peek().text)) return;
      const std::string near = NearestName(Peek().text, UnitNames());
      Fail("unknown unit '" + Peek().text + "'",
           near.empty() ? "units are m cm mm s ms N rad deg, and their quotients like cm/s" : "did you mean '" + near + "'?");
    }
    ++at_;
    quantity.value *= unit->si;
    quantity.dimension = unit->dimension;
    while (At("/") && Peek(1).kind == Token::Kind::kName) {
      const Unit* divisor = FindUnit(Peek(1).text);
      if (divisor == nullptr) return;
      at_ += 2;
      quantity.value /= divisor->si;
      quantity.dimension = Quotient(quantity.dimension, divisor->dimension);
    }
  }

  // Guards the stack against `((((((..`.
  struct Nested {
    explicit Nested(Parser& p) : parser(p) {
      if (++parser.depth_ > kMaxDepth) {
        --parser.depth_;
        parser.FailDeep();
      }
    }
    ~Nested() { --parser.depth_; }
    Nested(const Nested&) = delete;
    Nested& operator=(const Nested&) = delete;
    Parser& parser;
  };
  [[noreturn]] void FailDeep() {
    Fail("this is nested more than " + std::to_string(kMaxDepth) + " deep", "name a part of it with `condition`");
  }

  static std::vector<Expr> Args(Expr a) {
    std::vector<Expr> args;
    args.push_back(std::move(a));
    return args;
  }
  static std::vector<Expr> Args(Expr a, Expr b) {
    std::vector<Expr> args = Args(std::move(a));
    args.push_back(std::move(b));
    return args;
  }

  Expr Make(Expr::Kind kind, Place place, std::string text, std::vector<Expr> args) {
    int depth = 1;
    for (const Expr& arg : args) depth = std::max(depth, arg.depth + 1);
    if (depth > kMaxDepth) FailDeep();
    return {.kind = kind, .place = place, .text = std::move(text), .quantity = {}, .args = std::move(args), .depth = depth};
  }

  const GrammarText& grammar_;
  Diagnostics& diagnostics_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

bool IsReserved(std::string_view word) {
  return std::find(kItemWords.begin(), kItemWords.end(), word) != kItemWords.end() ||
         std::find(kOtherWords.begin(), kOtherWords.end(), word) != kOtherWords.end();
}

ast::File Parse(const GrammarText& grammar, Diagnostics& diagnostics) {
  const std::size_t before = diagnostics.size();
  Parser parser(grammar, diagnostics);
  if (diagnostics.size() != before) return {};
  return parser.ParseFile();
}

std::optional<Quantity> ParseQuantity(const GrammarText& text, Diagnostics& diagnostics) {
  const std::size_t before = diagnostics.size();
  Parser parser(text, diagnostics);
  if (diagnostics.size() != before) return std::nullopt;
  return parser.ParseOnlyQuantity();
}

}  // namespace prehend::grammar
