// SPDX-License-Identifier: Apache-2.0
// A claim is `[QUANTITY] EVENT {RELATION EVENT}`. Tested by
// tests/harness/truth/claims/parse_claim_test.cc
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <initializer_list>
#include <optional>
#include <utility>

#include "harness/base/base/number_text.h"
#include "harness/truth/claims/claim.h"

namespace prehend::truth {
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

bool IsCapital(char letter) { return letter >= 'A' && letter <= 'Z'; }

/// As a word: "two".
std::optional<int> NumberNamed(std::string_view word) {
  static constexpr std::string_view kWords[] = {"one",  "two", "three",  "four",
                                                "five", "six", "seven",  "eight",
                                                "nine", "ten", "eleven", "twelve"};
  const auto found = std::ranges::find(kWords, word);
  if (found == std::end(kWords)) return std::nullopt;
  return static_cast<int>(found - std::begin(kWords)) + 1;
}

bool IsRelation(std::string_view word) {
  return word == "then" || word == "while" || word == "lies" || word == "lie" ||
         grammar::AllenNamed(word);
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
    const std::size_t begin = first_event_ = next_.offset;
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
    if (!problem_ && IsAboutLimit(claim)) CheckLimit(claim);
    if (problem_) return tl::unexpected(std::move(*problem_));
    return claim;
  }

 private:
  /// What the physics may get wrong is said alone, of two things.
  void CheckLimit(const Claim& claim) {
    const ClaimedEvent& event = claim.events.front();
    const bool is_plain = claim.quantity == Quantity::kAtLeast && claim.number == 1 &&
                          claim.events.size() == 1 && event.roles.size() == 2 &&
                          event.roles[0].name.text.empty() && event.roles[1].name.text.empty();
    if (!is_plain)
      Fail(0, "what the physics may get wrong stands alone, with two things: " +
                  std::string(kLimitEvents[0]) + "(knife, board)");
  }

  void ParseQuantity(Claim& claim) {
    if (FailAtQuantity()) return;
    const std::size_t begin = next_.offset;
    TakeQuantity(claim);
    if (problem_ || next_.offset == begin || !IsQuantity()) return;
    const std::string_view first = Trimmed(text_.substr(begin, next_.offset - begin));
    Fail(next_.offset,
         fmt::format("a claim has one quantity, found '{}' after '{}'", next_.text, first),
         fmt::format("leave out '{}' or '{}'", first, next_.text));
  }

  /// Whether a quantity begins here. A word before a relation is an event.
  bool IsQuantity() {
    const bool may_be = next_.text == "no" || next_.text == "every" || next_.text == "exactly" ||
                        next_.text == "at" || next_.IsNumber() || NumberNamed(next_.text);
    return may_be && IsBeforeAnother();
  }

  /// Whether a name or a number follows that is no relation.
  bool IsBeforeAnother() {
    const Token first = next_;
    const std::size_t after = at_;
    Advance();
    const bool is = (next_.IsName() || next_.IsNumber()) && !IsRelation(next_.text);
    at_ = after;
    next_ = first;
    return is;
  }

  void TakeQuantity(Claim& claim) {
    if (Accept("no")) {
      claim.quantity = Quantity::kExactly;
      claim.number = 0;
    } else if (Accept("every")) {
      claim.quantity = Quantity::kEvery;
    } else if (Accept("exactly")) {
      claim.quantity = Quantity::kExactly;
      ParseNumber(claim);
    } else if (next_.IsNumber() || NumberNamed(next_.text)) {
      claim.quantity = Quantity::kExactly;
      ParseNumber(claim);
    } else if (Accept("at")) {
      if (next_.text != "least" && next_.text != "most")
        return Fail(next_.offset, "expected 'least' or 'most' after 'at', found " + Found(),
                    "at least 2 grasping, at most one sliding");
      claim.quantity = next_.text == "least" ? Quantity::kAtLeast : Quantity::kAtMost;
      Advance();
      ParseNumber(claim);
    }
  }

  /// Of words that people try. A word before another one that is no relation can be no event.
  bool FailAtQuantity() {
    struct Instead {
      std::string_view said, ours;
    };
    static constexpr Instead kInstead[] = {{"not", "no "},
                                           {"never", "no "},
                                           {"zero", "no "},
                                           {"none", "no "},
                                           {"without", "no "},
                                           {"a", ""},
                                           {"an", ""},
                                           {"some", ""},
                                           {"only", ""},
                                           {"just", ""},
                                           {"once", "one "},
                                           {"twice", "two "},
                                           {"each", "every "},
                                           {"all", "every "},
                                           {"several", "at least two "},
                                           {"more", "at least "},
                                           {"fewer", "at most "},
                                           {"less", "at most "},
                                           {"up", "at most "},
                                           {"both", "two "},
                                           {"many", "at least two "},
                                           {"few", ""},
                                           {"dozen", "12 "},
                                           {"thirteen", "13 "},
                                           {"fourteen", "14 "},
                                           {"fifteen", "15 "},
                                           {"sixteen", "16 "},
                                           {"seventeen", "17 "},
                                           {"eighteen", "18 "},
                                           {"nineteen", "19 "},
                                           {"twenty", "20 "},
                                           {"thirty", "30 "},
                                           {"forty", "40 "},
                                           {"fifty", "50 "},
                                           {"hundred", "100 "}};
    const auto instead = std::ranges::find(kInstead, next_.text, &Instead::said);
    if (instead == std::end(kInstead) || !IsBeforeAnother()) return false;
    const Token first = next_;
    Advance();
    Fail(first.offset, "expected a quantity or an event, found '" + std::string(first.text) + "'",
         RemedyForQuantity(first.text, instead->ours));
    return true;
  }

  /// `next_` is what follows the word.
  std::string RemedyForQuantity(std::string_view said, std::string_view ours) {
    const bool compares = said == "more" || said == "fewer" || said == "less" || said == "up";
    if (ours == "no " && next_.text == "one") Advance();  // "not one" is none
    if (!compares) return fmt::format("write: {}{}", ours, text_.substr(next_.offset));
    Advance();  // 'than' or 'to'
    std::optional<int> number = NumberNamed(next_.text);
    int digits = 0;
    if (next_.IsNumber() &&
        std::from_chars(next_.text.begin(), next_.text.end(), digits).ec == std::errc() &&
        digits < kMaxClaimedNumber)
      number = digits;
    Advance();
    if (said == "more" && number) ++*number;
    if ((said == "fewer" || said == "less") && number) --*number;
    if (!number || *number < 1) return "at least 2 grasping, at most one sliding, no sliding";
    return fmt::format("write: {}{} {}", ours, *number, text_.substr(next_.offset));
  }

  void ParseNumber(Claim& claim) {
    if (const auto number = NumberNamed(next_.text)) {
      claim.number = *number;
      Advance();
      return;
    }
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
    if (IsRelation(next_.text) && !claim.events.empty())
      return Fail(next_.offset, "expected an event, found " + Found(),
                  "one relation stands between two events: sliding before grasping");
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
      if (next_.IsNumber())
        Fail(next_.offset, "expected an entity or 'any', found " + Found(),
             "a claim asks who takes part, not for numbers; 'prehend run' prints the values of "
             "events");
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
    const std::string hint = RemedyForRelation();
    Fail(next_.offset,
         "expected 'then', 'while', 'lies inside' or one of Allen's relations, found " + Found(),
         hint);
  }

  /// `next_` is no relation.
  std::string RemedyForRelation() {
    const std::string_view before = Trimmed(text_.substr(0, next_.offset));
    std::string_view after = Trimmed(text_.substr(at_));
    const bool counts = next_.IsNumber() || NumberNamed(next_.text);
    const bool begins_claim = (counts || next_.text == "no" || next_.text == "every") &&
                              IsBeforeAnother() && !after.starts_with("times");
    if (begins_claim) after = text_.substr(next_.offset);
    if (begins_claim || next_.text == "and" || next_.text == "," || next_.text == ";")
      return after.empty()
                 ? ""
                 : fmt::format("two claims stand on two lines: '{}' and '{}'", before, after);
    if (next_.text == "or")
      return "claims hold together, there is no 'or': claim what is certain, or use "
             "'at least' and 'at most'";
    const std::string_view number = next_.text == "once"    ? "one"
                                    : next_.text == "twice" ? "two"
                                                            : next_.text;
    if (counts || number != next_.text)
      return fmt::format("the number stands first: {} {}", number,
                         Trimmed(text_.substr(first_event_, next_.offset - first_event_)));
    struct Instead {
      std::string_view said, ours;
    };
    // The longer of two that begin alike comes first.
    static constexpr Instead kInstead[] = {{"followed by", "then"},
                                           {"precedes", "before"},
                                           {"follows", "after"},
                                           {"during", "lies inside"},
                                           {"within", "lies inside"},
                                           {"in", "lies inside"},
                                           {"is before", "before"},
                                           {"is after", "after"},
                                           {"is inside", "lies inside"},
                                           {"is during", "lies inside"},
                                           {"happens before", "before"},
                                           {"happens after", "after"},
                                           {"happens during", "lies inside"},
                                           {"comes before", "before"},
                                           {"comes after", "after"},
                                           {"until", "meets"},
                                           {"when", "while"},
                                           {"with", "while"},
                                           {"as", "while"},
                                           {"immediately before", "meets"},
                                           {"right before", "meets"}};
    const std::string_view rest = text_.substr(next_.offset);
    for (const auto& [said, ours] : kInstead) {
      if (!rest.starts_with(said) || (rest.size() > said.size() && IsNameLetter(rest[said.size()])))
        continue;
      const std::string_view other = Trimmed(rest.substr(said.size()));
      return other.empty() ? fmt::format("that is '{}'", ours)
                           : fmt::format("write: {} {} {}", before, ours, other);
    }
    if (!next_.IsName()) return "";
    std::vector<std::string> words = {"then", "while", "lies inside"};
    words.insert(words.end(), grammar::kAllenNames.begin(), grammar::kAllenNames.end());
    return HintForName(next_.text, words);
  }

  ClaimWord ParseName(const char* wanted) {
    if (problem_) return {};
    ClaimWord word{std::string(next_.text), next_.offset};
    if (next_.IsName()) {
      Advance();
    } else if (const std::string capital = WordWithCapitals(); !capital.empty()) {
      Fail(next_.offset, fmt::format("expected {}, found '{}'", wanted, capital),
           fmt::format("write '{}': names have small letters", LowerCase(capital)));
    } else {
      Fail(next_.offset, fmt::format("expected {}, found {}", wanted, Found()));
    }
    return word;
  }

  /// That begins at `next_`; empty if it begins otherwise.
  std::string WordWithCapitals() const {
    std::size_t end = next_.offset;
    while (end < text_.size() && (IsNameLetter(text_[end]) || IsCapital(text_[end]))) ++end;
    const bool begins_so = end > next_.offset && IsCapital(text_[next_.offset]);
    return begins_so ? std::string(text_.substr(next_.offset, end - next_.offset)) : "";
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
  std::size_t at_ = 0, first_event_ = 0;
  Token next_;
  std::optional<ClaimProblem> problem_;
};

}  // namespace

tl::expected<Claim, ClaimProblem> ParseClaim(std::string_view text) {
  return ClaimParser(text).Parse();
}

std::string HintForName(std::string_view name, const std::vector<std::string>& known) {
  constexpr std::size_t kMaxListed = 20;
  const bool lists = !known.empty() && known.size() <= kMaxListed;
  return grammar::DidYouMean(name, known,
                             lists ? fmt::format("known: {}", fmt::join(known, ", ")) : "");
}

}  // namespace prehend::truth
