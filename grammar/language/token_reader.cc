// SPDX-License-Identifier: Apache-2.0
// The reserved words, and hints for words of other languages.
#include "grammar/language/token_reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <optional>

#include "grammar/base/utf8.h"

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
constexpr std::string_view kQuotes = "quotes are straight: \"";
constexpr std::string_view kBraces = "nothing stands around a definition: event e(..) while F";
constexpr std::array<Habit, 58> kHabits = {{
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
    {"&", "both must hold: F and G"},
    {"!", "it must not hold: not F"},
    {"%", "shares are plain numbers: 0.5"},
    {"^", "units are quotients: m/s/s"},
    {"\u2264", "'<=' compares"},
    {"\u2265", "'>=' compares"},
    {"\u2260", "'!=' compares"},
    {"\u2212", "a minus is '-'"},
    {"\u2013", "a minus is '-'"},
    {"\u00B0", "degrees are deg: 45 deg"},
    {"\u201C", kQuotes},
    {"\u201D", kQuotes},
    {"{", kBraces},
    {"}", kBraces},
    {";", "nothing ends a line or a definition"},
}};

bool IsItemWord(std::string_view word) {
  return std::find(kItemWords.begin(), kItemWords.end(), word) != kItemWords.end();
}

// Checks the text as a whole, then cuts it into tokens.

constexpr std::size_t kMaxFileBytes = std::size_t{1} << 20;

bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }

// Why this is no text, or "".
std::string WhyNotText(std::string_view text) {
  if (text.size() > kMaxFileBytes) return "the file is larger than 1 MiB; is this a grammar?";
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte < 0x20 && byte != '\n' && byte != '\r' && byte != '\t')
      return "this is a binary file, not a grammar";
    const std::size_t length = Utf8Length(text.substr(i));
    if (length == 0) return "the file is not valid UTF-8 text";
    i += length;
  }
  return {};
}

class Lexer {
 public:
  Lexer(const GrammarText& grammar, Diagnostics& diagnostics)
      : grammar_(grammar), diagnostics_(diagnostics) {}

  std::vector<Token> Run() {
    for (SkipBlanks(); at_ < text().size(); SkipBlanks()) Next();
    tokens_.push_back(
        {.kind = Token::Kind::kEnd, .text = "", .place = tokens_.empty() ? Here() : behind_last_});
    return std::move(tokens_);
  }

 private:
  std::string_view text() const { return grammar_.text; }
  char Peek(std::size_t ahead = 0) const {
    return at_ + ahead < text().size() ? text()[at_ + ahead] : '\0';
  }
  Place Here() const { return {line_, static_cast<int>(at_ - line_begin_) + 1}; }

  void SkipBlanks() {
    while (at_ < text().size()) {
      if (Peek() == '\n') {
        ++line_;
        line_begin_ = ++at_;
      } else if (Peek() == ' ' || Peek() == '\t' || Peek() == '\r') {
        ++at_;
      } else if (Peek() == '/' && Peek(1) == '/') {
        Complain("unexpected '//'", "a comment begins with '#'");
        while (at_ < text().size() && Peek() != '\n') ++at_;
      } else if (Peek() == '#') {
        while (at_ < text().size() && Peek() != '\n') ++at_;
      } else {
        return;
      }
    }
  }

  void Next() {
    if (IsLetter(Peek())) {
      Take(Token::Kind::kName, NameLength());
    } else if (IsDigit(Peek()) || (Peek() == '.' && IsDigit(Peek(1)))) {
      TakeNumber();
    } else if (Peek() == '"') {
      TakeText();
    } else {
      TakeSymbol();
    }
  }

  std::size_t NameLength() const {
    std::size_t length = 0;
    while (IsLetter(Peek(length)) || IsDigit(Peek(length))) ++length;
    return length;
  }

  void Take(Token::Kind kind, std::size_t length, double number = 0) {
    tokens_.push_back({kind, std::string(text().substr(at_, length)), Here(), number});
    at_ += length;
    behind_last_ = Here();
  }

  void TakeNumber() {
    double number = 0;
    const char* begin = text().data() + at_;
    const auto [end, error] = std::from_chars(begin, text().data() + text().size(), number);
    Take(Token::Kind::kNumber, static_cast<std::size_t>(end - begin), number);
    if (error == std::errc()) return;
    Complain("this number does not fit a double", {}, tokens_.back().place);
    Take(Token::Kind::kBad, 0);
  }

  void TakeText() {
    std::size_t length = 1;
    while (at_ + length < text().size() && Peek(length) != '"' && Peek(length) != '\n') ++length;
    const bool closed = Peek(length) == '"' && at_ + length < text().size();
    const Place place = Here();
    tokens_.push_back(
        {Token::Kind::kText, std::string(text().substr(at_ + 1, length - 1)), Here()});
    at_ += length + (closed ? 1 : 0);
    behind_last_ = Here();
    if (closed) return;
    Complain("this quote is not closed on its line", {}, place);
    Take(Token::Kind::kBad, 0);
  }

  void TakeSymbol() {
    static constexpr std::array<std::string_view, 4> kTwoBytes = {"<=", ">=", "==", "!="};
    static constexpr std::string_view kOneByte = "(),:=+-*/<>@|";
    for (const std::string_view symbol : kTwoBytes) {
      if (text().substr(at_, 2) == symbol) return Take(Token::Kind::kSymbol, 2);
    }
    if (kOneByte.find(Peek()) != std::string_view::npos) return Take(Token::Kind::kSymbol, 1);
    const std::size_t length = Utf8Length(text().substr(at_));
    const std::string found(text().substr(at_, length));
    if (found == ".") return TakeDot();
    Complain(IsOtherBlank(found) ? "unexpected character that looks like a blank, but is none"
                                 : "unexpected character '" + found + "'",
             IsOtherBlank(found) ? "separate with plain spaces" : std::string(HabitHint(found)));
    while (text().substr(at_, length) == found) at_ += length;  // `&&` is one mistake
    if (!IsOtherBlank(found) && found != ";") Take(Token::Kind::kBad, 0);
  }

  // `object.speed` of other languages; `hand.position.z` is one mistake.
  void TakeDot() {
    const std::string before = tokens_.empty() ? "" : tokens_.back().text;
    const bool is_name = !before.empty() && IsLetter(before[0]) && IsLetter(Peek(1));
    if (tokens_.size() < 2 || tokens_[tokens_.size() - 2].kind != Token::Kind::kBad) {
      ++at_;
      const std::string signal(text().substr(at_, NameLength()));
      --at_;
      Complain("unexpected character '.'",
               is_name         ? "a signal is asked of an entity: " + signal + "(" + before + ")"
               : before == ")" ? "a moment is E begins, or E ends"
                               : "");
    }
    Take(Token::Kind::kBad, 1);
  }

  static bool IsOtherBlank(std::string_view found) {
    return found == "\u00A0" || found == "\u2007" || found == "\u202F" || found == "\u3000" ||
           found == "\u200B" || found == "\uFEFF";
  }

  void Complain(std::string message, std::string hint = {}, std::optional<Place> place = {}) {
    if (diagnostics_.size() >= kMostDiagnostics) return;
    diagnostics_.push_back(DiagnosticAt(grammar_.file, text(), place.value_or(Here()),
                                        std::move(message), std::move(hint)));
  }

  const GrammarText& grammar_;
  Diagnostics& diagnostics_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  std::size_t line_begin_ = 0;
  int line_ = 1;
  Place behind_last_;  ///< the last token: where what is missing at the end was to stand
};

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
    : grammar_(grammar), diagnostics_(diagnostics), tokens_(Tokenize(grammar, diagnostics)) {
  for (std::size_t i = 0; i + 1 < tokens_.size(); ++i) {
    const std::string& next = tokens_[i + 1].text;
    if (next == ":" || next == "(" || next == "=") named_.insert(tokens_[i].text);
  }
}

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
  std::string word = MeantWord(at_);
  if (word.empty() && at_ > 0 && Peek().kind == Token::Kind::kName)
    word = MeantWord(at_ - 1, "not");
  if (HabitHint(Peek().text) == kMoment) hint = kMoment;
  if (!word.empty()) hint = "did you mean '" + word + "'?";
  if (At(",") || At(")")) hint = BracketHint(std::move(hint));
  FailAt(Peek().place, std::move(message), std::move(hint));
}

void TokenReader::Complain(Place place, std::string message, std::string hint) {
  if (diagnostics_.size() >= kMostDiagnostics) return;
  diagnostics_.push_back(
      DiagnosticAt(grammar_.file, grammar_.text, place, std::move(message), std::move(hint)));
}

// What is nearly this or another word of the language, and the name of nothing in this file; or
// such a word and the next one without a blank.
std::string TokenReader::MeantWord(std::size_t at, std::string_view wanted) const {
  const std::string& found = tokens_[at].text;
  if (tokens_[at].kind != Token::Kind::kName || IsReserved(found)) return {};
  std::vector<std::string> words = {std::string(wanted.empty() ? kItemWords[0] : wanted)};
  words.insert(words.end(), kItemWords.begin(), kItemWords.end());
  words.insert(words.end(), kOtherWords.begin(), kOtherWords.end());
  const bool is_named = named_.contains(found);
  for (const std::string& word : words) {
    if (!found.starts_with(word) || found == word) continue;
    const std::string rest = found.substr(word.size());
    const bool is_head = is_named && word.size() > 2 && rest[0] != '_';
    if (is_head || IsReserved(rest) || named_.contains(rest)) return word + " " + rest;
  }
  words.insert(words.end(), {"over", "onset", "one", "gap", "nearest", "lies", "all", "begin",
                             "phase", "grasp", "support"});
  const bool is_right = is_named || std::ranges::count(words, found) > 0;
  return is_right || !HabitHint(found).empty() ? "" : NearestName(found, words);
}

// It is read as what was meant, so that nothing but this is told of it.
bool TokenReader::Correct(const std::string& message, std::string_view wanted) {
  const std::string meant = MeantWord(at_, wanted);
  if (wanted.empty() ? !IsItemWord(meant) : meant != wanted) return false;
  Complain(Peek().place, message, "did you mean '" + meant + "'?");
  tokens_[at_].text = meant;
  return true;
}

std::string TokenReader::BracketHint(std::string otherwise) const {
  std::size_t i = at_;
  while (i > 0 && !IsItemWord(tokens_[i].text)) --i;
  for (int open = 0; ++i < tokens_.size() && !IsItemWord(tokens_[i].text);) {
    open += tokens_[i].text == "(" ? 1 : tokens_[i].text == ")" ? -1 : 0;
    if (open < 0)
      return "the ')' in line " + std::to_string(tokens_[i].place.line) + ", column " +
             std::to_string(tokens_[i].place.column) + " has no '(' before it";
  }
  return otherwise;
}

void TokenReader::FailAt(Place place, std::string message, std::string hint) {
  if (Peek().kind != Token::Kind::kBad) Complain(place, std::move(message), std::move(hint));
  throw ParseStop{};
}

void TokenReader::Expect(std::string_view text, std::string hint) {
  if (Accept(text)) return;
  const std::string message = "expected '" + std::string(text) + "', found " + Found();
  if (!Correct(message, text)) Fail(message, std::move(hint));
  SkipOne();
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
  if (!IsReserved(Peek().text)) return Take().text;
  // What begins a line goes on there with the next item; else the word was meant as a name.
  if (BeginsLine() && AtItem())
    Fail("expected " + std::string(what) + ", found " + Found(),
         "what stands in front of it is not complete");
  const Token word = Take();
  FailAt(word.place,
         "'" + word.text + "' is a word of the language and cannot be " + std::string(what),
         "choose another name");
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
  return {};
}

bool TokenReader::BeginsLine() const {
  return at_ == 0 || tokens_[at_ - 1].place.line != Peek().place.line;
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

std::vector<Token> Tokenize(const GrammarText& grammar, Diagnostics& diagnostics) {
  if (std::string why = WhyNotText(grammar.text); !why.empty()) {
    diagnostics.push_back({.file = grammar.file, .message = std::move(why)});
    return {Token{}};
  }
  return Lexer(grammar, diagnostics).Run();
}

}  // namespace prehend::grammar
