// SPDX-License-Identifier: Apache-2.0
// The reserved words, and hints for words of other languages.
#include "grammar/language/token_reader.h"

#include <algorithm>
#include <array>

namespace prehend::grammar {
namespace {

constexpr std::array<std::string_view, 8> kItemWords = {"grammar",   "use",   "param",     "define",
                                                        "condition", "event", "symmetric", "law"};
constexpr std::array<std::string_view, 38> kOtherWords = {
    "while",       "from",     "to",       "during",    "until",   "since",  "at",     "most",
    "back",        "rest",     "of",       "outside",   "compose", "where",  "repeat", "otherwise",
    "bridging",    "lasting",  "requires", "confirmed", "by",      "within", "with",   "without",
    "approaching", "receding", "slower",   "than",      "begins",  "ends",   "and",    "or",
    "not",         "any",      "style",    "drawn",     "known",   "each"};

/// Words of other languages, and what to write here instead.
struct Habit {
  std::string_view found;
  std::string_view hint;
};
constexpr std::string_view kOrder =
    "one after the other: from A to B, or compose a: E, b: F where a before b";
constexpr std::string_view kMoment = "a moment is E begins, or E ends";
constexpr std::string_view kAlone = "what is true or false is not compared: F, or not F";
constexpr std::string_view kDistance = "how far they are apart: distance(a, b) < 5 cm";
constexpr std::array<Habit, 43> kHabits = {{
    {"begin", kMoment},
    {"start", kMoment},
    {"end", kMoment},
    {"stop", kMoment},
    {"true", kAlone},
    {"false", kAlone},
    {"near", kDistance},
    {"close", kDistance},
    {"velocity", "how fast it moves: speed(object)"},
    {"angle", "how far it is turned: tilt(object), rotation(a, b), aligned(a, z, b, z)"},
    {"duration", "how long it holds: while F lasting 2 s"},
    {"position", "for example: distance(a, b), height(object)"},
    {"role", "a rule knows roles, not entities or classes by their names: give it a role"},
    {"z", "how high it is: height(object)"},
    {"sequence", "one after the other: compose a: E, b: F where a before b"},
    {"seq", "one after the other: compose a: E, b: F where a before b"},
    {"import", "another grammar is used: use NAME"},
    {"for", "how long it must hold at least: lasting 2 s"},
    {"within", "a deadline belongs to from A to B: from A to B within 2 s"},
    {"if", "what must hold: while F"},
    {"when", "what must hold: while F"},
    {"rule", "what is recognised is an event, what only other rules use a condition"},
    {"then", kOrder},
    {"after", kOrder},
    {"before", kOrder},
    {"between", "two limits, joined by 'and': x > 1 cm and x < 2 cm"},
    {"unless", "what must not hold: and not F"},
    {"always", "that it holds, and how long at least: while F lasting 2 s"},
    {"eventually", "that it comes in time: from A to B within 2 s"},
    {"exists", "some entity: any, for a role of an event or condition: contact(hand, any)"},
    {"forall", "a rule is found for each choice of entities by itself: give it roles"},
    {"def", "a value or a test: define NAME(a: Movable) = F"},
    {"let", "a value or a test: define NAME = F; a number: param NAME = 5 cm"},
    {"const", "a number: param NAME = 5 cm"},
    {"var", "a number: param NAME = 5 cm"},
    {"function", "a value or a test: define NAME(a: Movable) = F"},
    {"=", "'==' compares"},
    {"=>", "'>=' compares"},
    {"<", "one comparison at a time, joined by 'and': 1 cm < x and x < 2 cm"},
    {"<=", "one comparison at a time, joined by 'and': 1 cm < x and x < 2 cm"},
    {">", "one comparison at a time, joined by 'and': 2 cm > x and x > 1 cm"},
    {">=", "one comparison at a time, joined by 'and': 2 cm > x and x > 1 cm"},
    {"==", "one comparison at a time, joined by 'and'"},
}};

bool IsItemWord(std::string_view word) {
  return std::find(kItemWords.begin(), kItemWords.end(), word) != kItemWords.end();
}

}  // namespace

std::string_view HabitHint(std::string_view word) {
  const auto habit = std::ranges::find(kHabits, word, &Habit::found);
  return habit == kHabits.end() ? "" : habit->hint;
}

bool IsReserved(std::string_view word) {
  return IsItemWord(word) ||
         std::find(kOtherWords.begin(), kOtherWords.end(), word) != kOtherWords.end();
}

TokenReader::TokenReader(const GrammarText& grammar, Diagnostics& diagnostics)
    : grammar_(grammar), diagnostics_(diagnostics), tokens_(Tokenize(grammar, diagnostics)) {}

const Token& TokenReader::Peek(std::size_t ahead) const {
  return tokens_[std::min(at_ + ahead, tokens_.size() - 1)];
}

bool TokenReader::At(std::string_view text, std::size_t ahead) const {
  const Token::Kind kind = Peek(ahead).kind;
  return kind != Token::Kind::kEnd && kind != Token::Kind::kText && Peek(ahead).text == text;
}

Place TokenReader::End() const {
  const Token& token = tokens_[at_ == 0 ? 0 : at_ - 1];
  const std::size_t quotes = token.kind == Token::Kind::kText ? 2 : 0;
  return {token.place.line, token.place.column + static_cast<int>(token.text.size() + quotes)};
}

Token TokenReader::Take() {
  Token token = Peek();
  SkipOne();
  return token;
}

bool TokenReader::Accept(std::string_view text) {
  if (!At(text)) return false;
  ++at_;
  return true;
}

std::string TokenReader::Found() const {
  if (AtEnd()) return "the end of the file";
  return Peek().kind == Token::Kind::kText ? "\"" + Peek().text + "\"" : "'" + Peek().text + "'";
}

void TokenReader::Fail(std::string message, std::string hint) {
  FailAt(Peek().place, std::move(message), std::move(hint));
}

void TokenReader::Complain(Place place, std::string message, std::string hint) {
  if (diagnostics_.size() >= kMostDiagnostics) return;
  diagnostics_.push_back(
      DiagnosticAt(grammar_.file, grammar_.text, place, std::move(message), std::move(hint)));
}

void TokenReader::FailAt(Place place, std::string message, std::string hint) {
  if (Peek().kind != Token::Kind::kBad) Complain(place, std::move(message), std::move(hint));
  throw ParseStop{};
}

void TokenReader::Expect(std::string_view text, std::string hint) {
  if (!Accept(text))
    Fail("expected '" + std::string(text) + "', found " + Found(), std::move(hint));
}

// Where the line does not show the bracket, or what is missing may be missing anywhere, its place
// is told.
void TokenReader::ExpectToClose(const Token& bracket) {
  const bool is_far = AtEnd() || Peek().place.line != bracket.place.line;
  Expect(")", !is_far ? ""
                      : "the '(' in line " + std::to_string(bracket.place.line) + ", column " +
                            std::to_string(bracket.place.column) + " is not closed");
}

void TokenReader::ExpectAtMost() {
  Expect("at");
  Expect("most");
}

std::string TokenReader::ExpectName(std::string_view what) {
  if (Peek().kind != Token::Kind::kName)
    Fail("expected " + std::string(what) + ", found " + Found(),
         Peek().kind == Token::Kind::kNumber ? "a name begins with a letter"
         : Peek().kind == Token::Kind::kText && what.starts_with("a class")
             ? "what kind of thing it is, not which one: object: MilkCarton"
             : "");
  if (IsReserved(Peek().text)) {
    Fail("'" + Peek().text + "' is a word of the language and cannot be " + std::string(what),
         "choose another name");
  }
  return Take().text;
}

std::string TokenReader::WordHint(bool is_form) const {
  const std::string_view found =
      At("=") && At(">", 1) ? std::string_view("=>") : std::string_view(Peek().text);
  if (is_form && (found == "=" || found == ":" || At("(", 1)) && found != "sequence")
    return "say what must hold: while F, or from A to B";
  // What was read as a name may be the mistake: `while always F`.
  constexpr std::array<std::string_view, 4> kBeforeTests = {"always", "eventually", "exists",
                                                            "forall"};
  const std::string_view before = tokens_[at_ == 0 ? 0 : at_ - 1].text;
  const bool is_before = std::ranges::count(kBeforeTests, before) > 0;
  if (const std::string_view habit = HabitHint(is_before ? before : found); !habit.empty())
    return std::string(habit);
  std::vector<std::string> words(kItemWords.begin(), kItemWords.end());
  words.insert(words.end(), kOtherWords.begin(), kOtherWords.end());
  const std::string near = NearestName(Peek().text, words);
  return near.empty() || near == Peek().text ? std::string() : "did you mean '" + near + "'?";
}

bool TokenReader::AtItem() const {
  return Peek().kind == Token::Kind::kName && IsItemWord(Peek().text);
}

void TokenReader::SkipToItem() {
  while (!AtEnd() && !AtItem()) ++at_;
}

std::string TokenReader::NameOfItem(std::size_t position) const {
  if (!IsItemWord(tokens_[position].text)) return "";
  while (position < at_ && IsItemWord(tokens_[position].text)) ++position;
  const Token& token = tokens_[position];
  return token.kind == Token::Kind::kName && !IsReserved(token.text) ? token.text : "";
}

}  // namespace prehend::grammar
