// SPDX-License-Identifier: Apache-2.0
// Every form of a claim, and what is said of a text that is none.
#include <gtest/gtest.h>

#include <tuple>

#include "harness/truth/claims/claim.h"

namespace prehend::truth {
namespace {

using grammar::Allen;
using grammar::AllenSet;

Claim Parsed(const std::string& text) {
  const auto claim = ParseClaim(text);
  EXPECT_TRUE(claim) << text << ": " << claim.error().message;
  return claim.value_or(Claim{});
}

/// "offset: message | hint"
std::string Problem(const std::string& text) {
  const auto claim = ParseClaim(text);
  if (claim) return "";
  const ClaimProblem& problem = claim.error();
  return std::to_string(problem.offset) + ": " + problem.message +
         (problem.hint.empty() ? "" : " | " + problem.hint);
}

TEST(ParseClaim, WhatThePhysicsGetsWrongStandsAlone) {
  EXPECT_TRUE(IsAboutLimit(Parsed("goes_through(knife, board)")));
  EXPECT_TRUE(IsAboutLimit(Parsed("sinks_into(pot, coaster)")));
  EXPECT_FALSE(IsAboutLimit(Parsed("contact(pot, coaster)")));
  for (const char* wrong :
       {"no sinks_into(a, b)", "sinks_into(a)", "sinks_into(a, b) before contact(a, b)",
        "contact then goes_through(a, b)", "2 sinks_into(a, b)"})
    EXPECT_EQ(Problem(wrong),
              "0: what the physics may get wrong stands alone, with two things: "
              "goes_through(knife, board)")
        << wrong;
}

TEST(ParseClaim, ReadsQuantities) {
  const auto quantity = [](const std::string& text) {
    const Claim claim = Parsed(text);
    return std::tuple(claim.quantity, claim.number);
  };
  EXPECT_EQ(quantity("sliding"), std::tuple(Quantity::kAtLeast, 1));
  EXPECT_EQ(quantity("no sliding"), std::tuple(Quantity::kExactly, 0));
  EXPECT_EQ(quantity("one sliding"), std::tuple(Quantity::kExactly, 1));
  EXPECT_EQ(quantity("12 sliding"), std::tuple(Quantity::kExactly, 12));
  EXPECT_EQ(quantity("two sliding"), std::tuple(Quantity::kExactly, 2));
  EXPECT_EQ(quantity("twelve sliding"), std::tuple(Quantity::kExactly, 12));
  EXPECT_EQ(quantity("exactly one sliding"), std::tuple(Quantity::kExactly, 1));
  EXPECT_EQ(quantity("exactly 3 sliding"), std::tuple(Quantity::kExactly, 3));
  EXPECT_EQ(quantity("at least three sliding"), std::tuple(Quantity::kAtLeast, 3));
  EXPECT_EQ(quantity("not while sliding"), std::tuple(Quantity::kAtLeast, 1)) << "an event's name";
  EXPECT_EQ(quantity("at least 2 sliding"), std::tuple(Quantity::kAtLeast, 2));
  EXPECT_EQ(quantity("at most one sliding"), std::tuple(Quantity::kAtMost, 1));
  EXPECT_EQ(quantity("every sliding lies inside grasping"), std::tuple(Quantity::kEvery, 1));
}

TEST(ParseClaim, ReadsWhoTakesPart) {
  const Claim claim = Parsed("one grasping( right_hand,object=any , style=wrap)");
  EXPECT_EQ(claim.text, "one grasping( right_hand,object=any , style=wrap)");
  ASSERT_EQ(claim.events.size(), 1u);
  EXPECT_EQ(claim.events[0].name.text, "grasping");
  EXPECT_EQ(claim.events[0].name.offset, 4u);
  const std::vector<ClaimRole>& roles = claim.events[0].roles;
  ASSERT_EQ(roles.size(), 3u);
  EXPECT_EQ(roles[0].name.text, "");
  EXPECT_EQ(roles[0].value.text, "right_hand");
  EXPECT_EQ(roles[0].value.offset, 14u);
  EXPECT_EQ(roles[1].name.text, "object");
  EXPECT_EQ(roles[1].value.text, "any");
  EXPECT_EQ(roles[2].name.text, "style");
  EXPECT_EQ(roles[2].value.text, "wrap");
}

TEST(ParseClaim, ReadsRelations) {
  const auto relation = [](const std::string& word) {
    return Parsed("sliding " + word + " grasping").relations.at(0);
  };
  for (std::size_t i = 0; i < grammar::kAllenNames.size(); ++i)
    EXPECT_EQ(relation(std::string(grammar::kAllenNames[i])), Bit(static_cast<Allen>(i)));
  EXPECT_EQ(relation("contains | finished_by"), Bit(Allen::kContains) | Bit(Allen::kFinishedBy));
  EXPECT_EQ(relation("then"), relation("before|meets"));
  EXPECT_EQ(relation("lies inside"), relation("starts|inside|finishes|equals"));
  EXPECT_EQ(relation("while") | relation("before|meets|met_by|after"), AllenSet{0x1fff});
  EXPECT_EQ(relation("while") & relation("before|meets|met_by|after"), AllenSet{0});
  const Claim chain = Parsed("2 reaching(hand, cup) meets fixation then grasping");
  EXPECT_EQ(chain.events.size(), 3u);
  EXPECT_EQ(chain.relations, (std::vector<AllenSet>{Bit(Allen::kMeets), relation("then")}));
}

TEST(ParseClaim, SaysWhatIsWrongAndWhere) {
  const std::string relations =
      "expected 'then', 'while', 'lies inside' or one of Allen's relations, found ";
  EXPECT_EQ(Problem(""), "0: expected an event, found the end");
  EXPECT_EQ(Problem("no"), "2: expected an event, found the end");
  EXPECT_EQ(Problem("Sliding"),
            "0: expected an event, found 'Sliding' | write 'sliding': names have small letters");
  EXPECT_EQ(Problem("sliding(Right_hand)"),
            "8: expected an entity or 'any', found 'Right_hand' | write 'right_hand': names have "
            "small letters");
  EXPECT_EQ(Problem("gräsping"), "2: " + relations + "'ä'");
  EXPECT_EQ(Problem("0 sliding"),
            "0: expected a number from 1, found '0' | "
            "what does not happen: no sliding");
  EXPECT_EQ(Problem("10001 sliding"), "0: expected a number up to 10000, found '10001'");
  EXPECT_EQ(Problem("99999999999999999999 sliding"),
            "0: expected a number up to 10000, found '99999999999999999999'");
  EXPECT_EQ(Problem("at sliding"),
            "3: expected 'least' or 'most' after 'at', found 'sliding' | "
            "at least 2 grasping, at most one sliding");
  EXPECT_EQ(Problem("at least sliding"),
            "9: expected a number, found 'sliding' | at least 2 grasping");
  EXPECT_EQ(Problem("sliding()"), "8: expected an entity or 'any', found ')'");
  EXPECT_EQ(Problem("sliding(hand cup)"), "13: expected ',' or ')', found 'cup'");
  EXPECT_EQ(Problem("sliding(hand=)"), "13: expected an entity or 'any', found ')'");
  EXPECT_EQ(Problem("sliding(object=cup, hand)"),
            "20: expected ROLE=ENTITY, found 'hand' | "
            "what goes by its place comes before what goes by its name");
  EXPECT_EQ(Problem("sliding meet grasping"), "8: " + relations + "'meet' | did you mean 'meets'?");
  EXPECT_EQ(Problem("sliding during grasping"),
            "8: " + relations + "'during' | write: sliding lies inside grasping");
  EXPECT_EQ(Problem("sliding lies in grasping"), "13: expected 'inside' after 'lies', found 'in'");
  EXPECT_EQ(Problem("sliding meets"), "13: expected an event, found the end");
  EXPECT_EQ(Problem("sliding meets|"), "14: " + relations + "the end");
  EXPECT_EQ(Problem("every sliding"),
            "6: 'every' needs a relation to another event | "
            "say where each of them lies: every sliding lies inside grasping");
  std::string chain = "a";
  for (int i = 0; i < 16; ++i) chain += " then a";
  EXPECT_EQ(Problem(chain), "0: a claim has at most 16 events, found 17");
}

TEST(ParseClaim, WordsThatPeopleTryGetTheRemedy) {
  const auto quantity = [](const std::string& word) {
    return "0: expected a quantity or an event, found '" + word + "' | ";
  };
  EXPECT_EQ(Problem("not sliding(hand, cup)"), quantity("not") + "write: no sliding(hand, cup)");
  EXPECT_EQ(Problem("never sliding then a"), quantity("never") + "write: no sliding then a");
  EXPECT_EQ(Problem("a sliding"), quantity("a") + "write: sliding");
  EXPECT_EQ(Problem("only one sliding"), quantity("only") + "write: one sliding");
  EXPECT_EQ(Problem("all sliding lie inside grasping"),
            quantity("all") + "write: every sliding lie inside grasping");
  EXPECT_EQ(Problem("twice sliding"), quantity("twice") + "write: two sliding");
  EXPECT_EQ(Problem("more than two sliding"), quantity("more") + "write: at least 3 sliding");
  EXPECT_EQ(Problem("fewer than 3 sliding"), quantity("fewer") + "write: at most 2 sliding");
  EXPECT_EQ(Problem("less than 1 sliding"),
            quantity("less") + "at least 2 grasping, at most one sliding, no sliding");
  EXPECT_EQ(Problem("up to 4 sliding"), quantity("up") + "write: at most 4 sliding");
  EXPECT_EQ(Problem("not one sliding"), quantity("not") + "write: no sliding");
  EXPECT_EQ(Problem("exactly sliding"),
            "8: expected a number, found 'sliding' | at least 2 grasping");

  EXPECT_EQ(Problem("thirteen sliding(hand, cup)"),
            quantity("thirteen") + "write: 13 sliding(hand, cup)");
  EXPECT_EQ(Problem("twenty then sliding"), "") << "an event's name";
  EXPECT_EQ(Problem("no one sliding"),
            "3: a claim has one quantity, found 'one' after 'no' | leave out 'no' or 'one'");
  EXPECT_EQ(Problem("every no sliding"),
            "6: a claim has one quantity, found 'no' after 'every' | leave out 'every' or 'no'");
  EXPECT_EQ(Problem("at least 2 exactly 3 sliding"),
            "11: a claim has one quantity, found 'exactly' after 'at least 2' | leave out 'at "
            "least 2' or 'exactly'");
  EXPECT_EQ(Problem("no one then sliding"), "") << "an event's name";

  const std::string relation =
      "expected 'then', 'while', 'lies inside' or one of Allen's relations, found ";
  EXPECT_EQ(Problem("sliding(hand, cup) and no grasping"),
            "19: " + relation +
                "'and' | two claims stand on two lines: 'sliding(hand, cup)' and 'no grasping'");
  EXPECT_EQ(Problem("sliding, grasping"),
            "7: " + relation + "',' | two claims stand on two lines: 'sliding' and 'grasping'");
  EXPECT_EQ(Problem("sliding or grasping"),
            "8: " + relation +
                "'or' | claims hold together, there is no 'or': claim what is certain, or use "
                "'at least' and 'at most'");
  EXPECT_EQ(Problem("one sliding followed by grasping"),
            "12: " + relation + "'followed' | write: one sliding then grasping");
  EXPECT_EQ(Problem("sliding happens before grasping"),
            "8: " + relation + "'happens' | write: sliding before grasping");
  EXPECT_EQ(Problem("sliding precedes grasping"),
            "8: " + relation + "'precedes' | write: sliding before grasping");
  EXPECT_EQ(Problem("sliding twice"), "8: " + relation +
                                          "'twice' | the number stands first: "
                                          "two sliding");
  EXPECT_EQ(Problem("sliding 3 times"), "8: " + relation +
                                            "'3' | the number stands first: "
                                            "3 sliding");
  EXPECT_EQ(Problem("one sliding twice"), "12: " + relation +
                                              "'twice' | the number stands first: "
                                              "two sliding");
  EXPECT_EQ(Problem("one grasping(hand, cup) one transporting"),
            "24: " + relation +
                "'one' | two claims stand on two lines: 'one grasping(hand, cup)' and 'one "
                "transporting'");
  EXPECT_EQ(Problem("sliding no grasping"),
            "8: " + relation + "'no' | two claims stand on two lines: 'sliding' and 'no grasping'");
  EXPECT_EQ(Problem("sliding starts before grasping"),
            "15: expected an event, found 'before' | "
            "one relation stands between two events: sliding before grasping");
  EXPECT_EQ(Problem("pouring(hand, amount=3)"),
            "21: expected an entity or 'any', found '3' | a claim asks who takes part, not for "
            "numbers; 'prehend run' prints the values of events");
}

}  // namespace
}  // namespace prehend::truth
