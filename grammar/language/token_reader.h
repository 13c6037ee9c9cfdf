// SPDX-License-Identifier: Apache-2.0
// A grammar's tokens one after another, and what to say about one that does not fit. Part of the
// parser. Tested by tests/grammar/language/parser_test.cc
#pragma once

#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "grammar/base/diagnostic.h"
#include "grammar/base/source.h"

namespace prehend::grammar {

// Grammar text -> tokens. Line ends mean nothing; `#` starts a comment.

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

/// Words that cannot name a role, a parameter or a rule.
bool IsReserved(std::string_view word);
/// What to write in the place of a word of other languages; "" of others.
std::string_view HabitHint(std::string_view word);

/// Thrown inside the parser only: unwinds to the next item after the complaint was written down.
struct ParseStop {};

class TokenReader {
 public:
  TokenReader(const GrammarText& grammar, Diagnostics& diagnostics);

 protected:
  const Token& Peek(std::size_t ahead = 0) const;
  /// Behind the token that was taken last.
  Place End() const;
  bool AtEnd() const { return Peek().kind == Token::Kind::kEnd; }
  bool At(std::string_view text, std::size_t ahead = 0) const;
  Token Take();
  void SkipOne() {
    if (!AtEnd()) ++at_;
  }
  bool Accept(std::string_view text);
  std::string Found() const;

  void Complain(Place place, std::string message, std::string hint = {});
  [[noreturn]] void Fail(std::string message, std::string hint = {});
  [[noreturn]] void FailAt(Place place, std::string message, std::string hint = {});
  void Expect(std::string_view text, std::string hint = {});
  void ExpectAtMost();
  /// The ')' of this '('.
  void ExpectToClose(const Token& bracket);
  std::string ExpectName(std::string_view what);
  /// How it is said here, or where a form must begin, when the next token is a word of other
  /// languages.
  std::string WordHint(bool is_form = false) const;
  /// Whether the next token is nearly the word that is wanted, or one that begins an item: that is
  /// told, and it is read as the word.
  bool Correct(const std::string& message, std::string_view wanted = {});
  bool BeginsLine() const;
  bool AtItem() const;
  void SkipToItem();
  std::size_t Position() const { return at_; }
  /// What the item that begins there defines; "" if it does not come so far.
  std::string NameOfItem(std::size_t position) const;
  void SkipToEnd() { at_ = tokens_.size() - 1; }

 private:
  std::string MeantWord(std::size_t at, std::string_view wanted = {}) const;
  /// The next ')' that closes nothing, if there is one.
  std::string BracketHint(std::string otherwise) const;

  const GrammarText& grammar_;
  Diagnostics& diagnostics_;
  std::vector<Token> tokens_;
  std::set<std::string, std::less<>> named_;  ///< what stands before a ':', a '(' or a '='
  std::size_t at_ = 0;
};

}  // namespace prehend::grammar
