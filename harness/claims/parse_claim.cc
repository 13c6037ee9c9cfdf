// SPDX-License-Identifier: Apache-2.0
// A claim is `[QUANTITY] EVENT {RELATION EVENT}`. Tested by
// tests/harness/claims/parse_claim_test.cc
#include "harness/claims/parse_claim.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <initializer_list>
#include <optional>
#include <utility>

namespace prehend::harness {
namespace {

using grammar::Allen;
using grammar::AllenSet;

AllenSet AnyOf(std::initializer_list<Allen> relations) {
  AllenSet all = 0;
  for (const Allen relation : relations) all |= Bit(relation);
  return all;
}

// What the words that are not Allen's stand for.
AllenSet Then() { return AnyOf({Allen::kBefore, Allen::kMeets}); }
AllenSet LiesInside() {
  return AnyOf({Allen::kStarts, Allen::kDuring, Allen::kFinishes, Allen::kEquals});
}
AllenSet While() {
  constexpr AllenSet kAll = (1U << grammar::kAllenNames.size()) - 1;
  const AllenSet apart = AnyOf({Allen::kBefore, Allen::kMeets, Allen::kMetBy, Allen::kAfter});
  return static_cast<AllenSet>(kAll & ~apart);
}

bool IsDigit(char letter) { return letter >= '0' && letter <= '9'; }
bool IsNameLetter(char letter) {
  return (letter >= 'a' && letter <= 'z') || IsDigit(letter) || letter == '_';
}

/// A name, a number, or a single other letter; empty at the end.
struct Token {
  std::string_view text;
  std::size_t offset = 0;

  bool IsName() const { return !text.empty() && IsNameLetter(text[0]) && !IsDigit(text[0]); }
  bool IsNumber() const { return !text.empty() && std::ranges::all_of(text, IsDigit); }
};

class ClaimParser {
 public:
  explicit ClaimParser(std::string_view text) : text_(text) { Advance(); }

  tl::expected<Claim, ClaimProblem> Parse() {
    Claim claim;
    claim.text = std::string(text_);
    ParseQuantity(claim);
    const std::size_t begin = next_.offset;
    ParseEvent(claim);
    while (!problem_ && !next_.text.empty()) {
      ParseRelation(claim);
      ParseEvent(claim);
    }
    if (claim.quantity == Quantity::kEvery && claim.relations.empty())
      Fail(begin, "'every' needs a relation to another event",
           "say where each of them lies: every sliding lies inside grasping");
    if (claim.events.size() > kMaxClaimedEvents)
      Fail(0, fmt::format("a claim has at most {} events, found {}", kMaxClaimedEvents,
                          claim.events.size()));
    if (problem_) return tl::unexpected(std::move(*problem_));
    return claim;
  }

 private:
  void ParseQuantity(Claim& claim) {
    const bool is_word = next_.text == "no" || next_.text == "one" || next_.text == "every";
    if (is_word || next_.IsNumber()) {
      claim.quantity = next_.text == "every" ? Quantity::kEvery : Quantity::kExactly;
      if (next_.text == "no") {
        claim.number = 0;
        Advance();
      } else if (next_.text == "every") {
        Advance();
      } else {
        ParseNumber(claim);
      }
      return;
    }
    if (!Accept("at")) return;
    if (next_.text != "least" && next_.text != "most")
      return Fail(next_.offset, "expected 'least' or 'most' after 'at', found " + Found(),
                  "at least 2 grasping, at most one sliding");
    claim.quantity = next_.text == "least" ? Quantity::kAtLeast : Quantity::kAtMost;
    Advance();
    ParseNumber(claim);
  }

  void ParseNumber(Claim& claim) {
    if (Accept("one")) return;
    if (!next_.IsNumber())
      return Fail(next_.offset, "expected a number, found " + Found(), "at least 2 grasping");
    int number = 0;
    const auto read =
        std::from_chars(next_.text.data(), next_.text.data() + next_.text.size(), number);
    if (read.ec != std::errc() || number > kMaxClaimedNumber)
      return Fail(next_.offset, fmt::format("expected a number up to {}, found '{}'",
                                            kMaxClaimedNumber, next_.text));
    if (number == 0)
      return Fail(next_.offset, "expected a number from 1, found '0'",
                  "what does not happen: no sliding");
    claim.number = number;
    Advance();
  }

  void ParseEvent(Claim& claim) {
    if (problem_) return;
    ClaimedEvent& event = claim.events.emplace_back();
    event.name = ParseName("an event");
    if (!Accept("(")) return;
    do {
      event.roles.push_back(ParseRole(event));
    } while (Accept(","));
    if (!Accept(")")) Fail(next_.offset, "expected ',' or ')', found " + Found());
  }

  ClaimRole ParseRole(const ClaimedEvent& event) {
    ClaimRole role;
    role.value = ParseName("an entity or 'any'");
    if (Accept("=")) {
      role.name = std::exchange(role.value, {});
      role.value = ParseName("an entity or 'any'");
      return role;
    }
    if (!event.roles.empty() && !event.roles.back().name.text.empty())
      Fail(role.value.offset, "expected ROLE=ENTITY, found '" + role.value.text + "'",
           "what goes by its place comes before what goes by its name");
    return role;
  }

  void ParseRelation(Claim& claim) {
    if (Accept("then")) return claim.relations.push_back(Then());
    if (Accept("while")) return claim.relations.push_back(While());
    if (Accept("lies") || Accept("lie")) {
      if (!Accept("inside")) Fail(next_.offset, "expected 'inside' after 'lies', found " + Found());
      return claim.relations.push_back(LiesInside());
    }
    AllenSet relations = 0;
    do {
      const auto relation = grammar::AllenNamed(next_.text);
      if (!relation) return FailAtRelation();
      relations |= Bit(*relation);
      Advance();
    } while (Accept("|"));
    claim.relations.push_back(relations);
  }

  void FailAtRelation() {
    std::string hint;
    if (next_.text == "during") {
      hint = "with both ends in it, that is 'lies inside': sliding lies inside grasping";
    } else if (next_.IsName()) {
      std::vector<std::string> words = {"then", "while", "lies inside"};
      words.insert(words.end(), grammar::kAllenNames.begin(), grammar::kAllenNames.end());
      hint = HintForName(next_.text, words);
    }
    Fail(next_.offset,
         "expected 'then', 'while', 'lies inside' or one of Allen's relations, found " + Found(),
         std::move(hint));
  }

  ClaimWord ParseName(const char* wanted) {
    if (problem_) return {};
    ClaimWord word{std::string(next_.text), next_.offset};
    if (next_.IsName()) {
      Advance();
    } else {
      Fail(next_.offset, fmt::format("expected {}, found {}", wanted, Found()));
    }
    return word;
  }

  bool Accept(std::string_view text) {
    if (problem_ || next_.text != text) return false;
    Advance();
    return true;
  }

  void Advance() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
    const std::size_t begin = at_;
    while (at_ < text_.size() && IsNameLetter(text_[at_])) ++at_;
    if (at_ == begin && at_ < text_.size()) {
      do ++at_;  // a letter beyond ASCII has several bytes
      while (at_ < text_.size() && (static_cast<unsigned char>(text_[at_]) & 0xC0U) == 0x80U);
    }
    next_ = {text_.substr(begin, at_ - begin), begin};
  }

  std::string Found() const {
    return next_.text.empty() ? "the end" : "'" + std::string(next_.text) + "'";
  }

  /// The first problem counts.
  void Fail(std::size_t offset, std::string message, std::string hint = {}) {
    if (!problem_) problem_ = ClaimProblem{offset, std::move(message), std::move(hint)};
  }

  std::string_view text_;
  std::size_t at_ = 0;
  Token next_;
  std::optional<ClaimProblem> problem_;
};

}  // namespace

tl::expected<Claim, ClaimProblem> ParseClaim(std::string_view text) {
  return ClaimParser(text).Parse();
}

std::string HintForName(std::string_view name, const std::vector<std::string>& known) {
  constexpr std::size_t kMaxListed = 20;
  const std::string near = grammar::NearestName(name, known);
  if (!near.empty()) return fmt::format("did you mean '{}'?", near);
  if (known.empty() || known.size() > kMaxListed) return "";
  return fmt::format("known: {}", fmt::join(known, ", "));
}

}  // namespace prehend::harness
