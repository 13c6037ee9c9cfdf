// SPDX-License-Identifier: Apache-2.0
// Checks the text as a whole, then cuts it into tokens.
#include "grammar/language/lexer.h"

#include <array>
#include <charconv>
#include <cstddef>
#include <optional>

namespace prehend::grammar {
namespace {

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
