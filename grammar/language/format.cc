// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string_view>

#include "grammar/base/quantity.h"
#include "grammar/language/parser.h"
#include "grammar/language/token_reader.h"

namespace prehend::grammar {
namespace {

using Kind = Token::Kind;

/// What begins a line that is not indented, and a clause of a definition.
constexpr std::array<std::string_view, 8> kItems = {"grammar",   "use",   "param",     "define",
                                                    "condition", "event", "symmetric", "law"};
constexpr std::array<std::string_view, 24> kClauses = {
    "while",    "from",    "to",       "until",     "since", "approaching", "at",      "within",
    "during",   "rest",    "outside",  "compose",   "where", "all",         "repeat",  "otherwise",
    "bridging", "lasting", "requires", "confirmed", "with",  "drawn",       "without", "one"};

template <std::size_t N>
bool IsOneOf(const std::array<std::string_view, N>& words, const Token& token) {
  return token.kind == Kind::kName && std::ranges::count(words, token.text) > 0;
}

class Layout {
 public:
  Layout(const std::string& text, const std::vector<Token>& tokens) : text_(text), tokens_(tokens) {
    lines_.push_back(0);
    for (std::size_t at = 0; at < text.size(); ++at)
      if (text[at] == '\n') lines_.push_back(at + 1);
  }

  std::string Run() {
    std::size_t at = 0;
    for (std::size_t i = 0; i < tokens_.size(); ++i) {
      const bool is_end = tokens_[i].kind == Kind::kEnd;
      const std::size_t begin = is_end ? text_.size() : Offset(tokens_[i]);
      Between(std::string_view(text_).substr(at, begin - at), i);
      if (is_end) break;
      at = begin + tokens_[i].text.size() + (tokens_[i].kind == Kind::kText ? 2 : 0);
      const std::string_view written = std::string_view(text_).substr(begin, at - begin);
      const bool opens = written == "(", closes = written == ")";
      depth_ = closes ? std::max(depth_ - 1, 0) : depth_ + (opens ? 1 : 0);
      in_unit_ = StaysUnit(i);
      if (IsOneOf(kItems, tokens_[i])) in_law_ = written == "law";
      out_ += written;
    }
    return std::move(out_);
  }

 private:
  std::size_t Offset(const Token& token) const {
    return lines_[static_cast<std::size_t>(token.place.line) - 1] +
           static_cast<std::size_t>(token.place.column) - 1;
  }

  /// After a number, `cm` and `/ s` belong to it; after a colon, they are a dimension.
  bool StaysUnit(std::size_t i) const {
    const Token& token = tokens_[i];
    if (token.kind == Kind::kNumber) return true;
    const bool is_unit = token.kind == Kind::kName && FindUnit(token.text) != nullptr;
    if (is_unit) return in_unit_ || (i > 0 && tokens_[i - 1].text == ":");
    return token.text == "/" && in_unit_ && IsUnit(i + 1);
  }
  bool IsUnit(std::size_t i) const {
    return i < tokens_.size() && tokens_[i].kind == Kind::kName &&
           FindUnit(tokens_[i].text) != nullptr;
  }

  /// What stands before token `i`: comments, line breaks, blanks.
  void Between(std::string_view gap, std::size_t i) {
    bool broken = out_.empty();  // at the begin of a line
    int breaks = 0;
    for (std::size_t at = 0; at < gap.size(); ++at) {
      if (gap[at] == '\n') {
        ++breaks;
      } else if (gap[at] == '#') {
        const std::size_t end = std::min(gap.find('\n', at), gap.size());
        const std::size_t blanks = at - (gap.substr(0, at).find_last_not_of(" \t") + 1);
        Break(breaks, broken);
        broken ? Indent(i) : void(out_.append(std::max<std::size_t>(blanks, 1), ' '));
        out_ += gap.substr(at, end - at);
        out_.erase(out_.find_last_not_of(" \t\r") + 1);
        broken = false;
        breaks = 0;
        at = end - 1;
      }
    }
    if (tokens_[i].kind == Kind::kEnd) {
      if (!out_.empty()) out_ += '\n';
      return;
    }
    Break(breaks, broken);
    if (broken) return Indent(i);
    const bool is_aligned = tokens_[i].text == "=" && i > 1 && tokens_[i - 2].text == "param";
    // `0.3 / s` and `0.3/s` are left to the author.
    const std::size_t slash = tokens_[i].text == "/" ? i : i - 1;
    const bool is_rate = in_unit_ && i > 1 && tokens_[slash].text == "/" &&
                         tokens_[slash - 1].kind == Kind::kNumber && !gap.empty();
    const bool is_apart = is_aligned || is_rate || NeedsBlank(i);
    out_.append(is_aligned ? std::max<std::size_t>(gap.size(), 1) : is_apart ? 1 : 0, ' ');
  }

  void Break(int breaks, bool& broken) {
    if (breaks == 0 || out_.empty()) return;
    out_.append(std::min(breaks, 2), '\n');
    broken = true;
  }

  /// A comment stands where what follows it stands.
  void Indent(std::size_t i) {
    const Token& token = tokens_[i];
    const bool is_item = token.kind == Kind::kEnd || (IsOneOf(kItems, token) && depth_ == 0);
    const bool after_comma = i > 0 && tokens_[i - 1].text == ",";
    const bool is_drop = token.text == "or" && tokens_[i + 1].text == "drop";
    const bool begins = in_law_ || is_drop || (i > 0 && tokens_[i - 1].text == "=");
    const bool is_clause = depth_ == 0 && !after_comma && (IsOneOf(kClauses, token) || begins);
    // `and` binds more tightly than an `or` in a line before, of the same brackets.
    if (token.text == "or" || is_item || is_clause) or_depth_ = is_item || is_clause ? -1 : depth_;
    const bool after_or = token.text == "and" && or_depth_ == depth_;
    const std::size_t deeper = static_cast<std::size_t>(depth_) + (after_or ? 1 : 0);
    out_.append(is_item ? 0 : is_clause ? 2 : 4 + 2 * deeper, ' ');
  }

  bool NeedsBlank(std::size_t i) const {
    const std::string& now = tokens_[i].text;
    const Token& last = tokens_[i - 1];
    if (tokens_[i].kind == Kind::kText || last.kind == Kind::kText) return now != "," && now != ")";
    if (now == "," || now == ")" || now == ":" || now == "@" || now == "|") return false;
    if (last.text == "(" || last.text == "@" || last.text == "|") return false;
    if (now == "(") return last.kind != Kind::kName || IsWord(last);
    if (now == "/" && in_unit_ && IsUnit(i + 1)) return false;
    if (last.text == "/" && in_unit_) return false;
    const bool is_sign = last.text == "-" && (i < 2 || !EndsValue(tokens_[i - 2]));
    return !is_sign;
  }

  /// A word of the language after which a bracket is no call's.
  static bool IsWord(const Token& token) {
    constexpr std::array<std::string_view, 8> kBefore = {"and",  "or",   "not", "known",
                                                         "than", "most", "by",  "of"};
    return IsOneOf(kBefore, token) || IsOneOf(kClauses, token);
  }
  static bool EndsValue(const Token& token) {
    return token.kind == Kind::kNumber || token.text == ")" ||
           (token.kind == Kind::kName && !IsWord(token));
  }

  const std::string& text_;
  const std::vector<Token>& tokens_;
  std::vector<std::size_t> lines_;  // where each begins
  std::string out_;
  int depth_ = 0;
  bool in_unit_ = false;
  bool in_law_ = false;
  int or_depth_ = -1;  // of the last line that began with it
};

}  // namespace

std::string FormatText(const GrammarText& grammar) {
  Diagnostics diagnostics;
  const std::vector<Token> tokens = Tokenize(grammar, diagnostics);
  return diagnostics.empty() ? Layout(grammar.text, tokens).Run() : grammar.text;
}

}  // namespace prehend::grammar
