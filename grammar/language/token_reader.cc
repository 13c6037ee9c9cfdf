// SPDX-License-Identifier: Apache-2.0
// The reserved words, and hints for words of other languages.
#include "grammar/language/token_reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <optional>

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

// Checks the text as a whole, then cuts it into tokens.

constexpr std::size_t kMaxFileBytes = std::size_t{1} << 20;

bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }

// Length of the UTF-8 sequence that starts at `i`, 0 if there is none (overlong forms and
// surrogates count as none).
std::size_t Utf8Length(std::string_view text, std::size_t i) {
  const auto byte = [&](std::size_t k) {
    return k < text.size() ? static_cast<unsigned char>(text[k]) : 0;
  };
  const auto follows = [&](std::size_t k) { return (byte(k) & 0xc0) == 0x80; };
  const int lead = byte(i);
  if (lead < 0x80) return 1;
  if (lead >= 0xc2 && lead < 0xe0) return follows(i + 1) ? 2 : 0;
  if (lead >= 0xe0 && lead < 0xf0) {
    const bool overlong = lead == 0xe0 && byte(i + 1) < 0xa0;
    const bool surrogate = lead == 0xed && byte(i + 1) >= 0xa0;
    return !overlong && !surrogate && follows(i + 1) && follows(i + 2) ? 3 : 0;
  }
  if (lead >= 0xf0 && lead < 0xf5) {
    const bool overlong = lead == 0xf0 && byte(i + 1) < 0x90;
    const bool too_large = lead == 0xf4 && byte(i + 1) >= 0x90;
    return !overlong && !too_large && follows(i + 1) && follows(i + 2) && follows(i + 3) ? 4 : 0;
  }
  return 0;
}

// Why this is no text, or "".
std::string WhyNotText(std::string_view text) {
  if (text.size() > kMaxFileBytes) return "the file is larger than 1 MiB; is this a grammar?";
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte < 0x20 && byte != '\n' && byte != '\r' && byte != '\t')
      return "this is a binary file, not a grammar";
    const std::size_t length = Utf8Length(text, i);
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
    const std::size_t length = Utf8Length(text(), at_);
    const std::string found(text().substr(at_, length));
    if (found == ".") return TakeDot();
    Complain(IsOtherBlank(found) ? "unexpected character that looks like a blank, but is none"
                                 : "unexpected character '" + found + "'",
             HintFor(found));
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

  /// What it means in other languages.
  static std::string HintFor(std::string_view found) {
    if (found == "&") return "both must hold: F and G";
    if (found == "|") return "one of them must hold: F or G";
    if (found == "!") return "it must not hold: not F";
    if (found == "%") return "shares are plain numbers: 0.5";
    if (found == "^") return "units are quotients: m/s/s";
    if (found == "\u2264") return "'<=' compares";
    if (found == "\u2265") return "'>=' compares";
    if (found == "\u2260") return "'!=' compares";
    if (found == "\u2212" || found == "\u2013") return "a minus is '-'";
    if (found == "\u00B0") return "degrees are deg: 45 deg";
    if (IsOtherBlank(found)) return "separate with plain spaces";
    if (found == "\u201C" || found == "\u201D") return "quotes are straight: \"";
    if (found == "{" || found == "}")
      return "nothing stands around a definition: event e(..) while F";
    if (found == ";") return "nothing ends a line or a definition";
    return {};
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
  if (!IsReserved(Peek().text)) return Take().text;
  // What begins a line goes on there with the next item; else the word was meant as a name.
  const bool begins_line = at_ == 0 || tokens_[at_ - 1].place.line != Peek().place.line;
  if (begins_line && AtItem())
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

std::vector<Token> Tokenize(const GrammarText& grammar, Diagnostics& diagnostics) {
  if (std::string why = WhyNotText(grammar.text); !why.empty()) {
    diagnostics.push_back({.file = grammar.file,
                           .place = {},
                           .message = std::move(why),
                           .source_line = {},
                           .hint = {}});
    return {Token{}};
  }
  return Lexer(grammar, diagnostics).Run();
}

}  // namespace prehend::grammar
