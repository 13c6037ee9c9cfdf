// SPDX-License-Identifier: Apache-2.0
// Which events a claim is about, and names that there are not.
#include "harness/truth/claims/judge_claims.h"
#include "tests/harness/truth/claims/claimed_stage.h"

namespace prehend::truth {
namespace {

std::string Text(const std::vector<ClaimProblem>& problems) {
  std::string text;
  for (const ClaimProblem& problem : problems)
    text += std::to_string(problem.offset) + ": " + problem.message +
            (problem.hint.empty() ? "" : " | " + problem.hint) + "\n";
  return text;
}
std::string Mismatch(const std::string& claim) {
  return Text(Mismatches(ClaimOf(claim), StageOfClaims()));
}
std::string Unknown(const std::string& claim) {
  return Text(UnknownNames(ClaimOf(claim), StageOfClaims()));
}

TEST(FitClaim, RolesAreMeantByPlaceOrByName) {
  const auto fits = [](const std::string& claim, const grammar::NamedEvent& event) {
    return Fits(event, ClaimOf(claim).events[0], StageOfClaims());
  };
  const grammar::NamedEvent grasp = Happened("grasping", "hand", "cup", {1, 2}, "wrap");
  for (const char* claim :
       {"grasping", "grasping(hand)", "grasping(hand, cup)", "grasping(any, cup)",
        "grasping(object=cup)", "grasping(hand, style=wrap)", "grasping(object=cup, hand=hand)",
        "grasping(hand, any, style=any)"})
    EXPECT_TRUE(fits(claim, grasp)) << claim;
  for (const char* claim :
       {"sliding", "grasping(hand, jug)", "grasping(object=jug)", "grasping(hand, style=pinch)"})
    EXPECT_FALSE(fits(claim, grasp)) << claim;
  EXPECT_FALSE(fits("grasping(style=wrap)", Happened("grasping", "hand", "cup", {1, 2})));
}

TEST(FitClaim, TheTwoOfASymmetricEventStandInEitherOrder) {
  const grammar::NamedEvent touch = Happened("contact", "cup", "hand", {1, 2});
  const ClaimableEvents known = StageOfClaims();
  EXPECT_TRUE(Fits(touch, ClaimOf("contact(cup, hand)").events[0], known));
  EXPECT_TRUE(Fits(touch, ClaimOf("contact(hand, cup)").events[0], known));
  EXPECT_TRUE(Fits(touch, ClaimOf("contact(hand)").events[0], known));
  EXPECT_FALSE(Fits(touch, ClaimOf("contact(hand, hand)").events[0], known));
  EXPECT_FALSE(Fits(touch, ClaimOf("contact(jug, hand)").events[0], known));
}

TEST(FitClaim, WhatTheGrammarDoesNotHaveIsAMismatch) {
  EXPECT_EQ(Mismatch("grasping(hand, cup, style=wrap) meets sliding(any, cup)"), "");
  EXPECT_EQ(Mismatch("no slidin"),
            "3: grammar 'stage' has no event 'slidin' | did you mean "
            "'sliding'?\n");
  EXPECT_EQ(Mismatch("pushing"),
            "0: grammar 'stage' has no event 'pushing' | "
            "known: grasping, sliding, contact\n");
  EXPECT_EQ(Mismatch("sliding(hand, cup, table)"),
            "19: 'sliding' has 2 roles | "
            "it is sliding(hand, object)\n");
  EXPECT_EQ(Mismatch("sliding(objekt=cup)"),
            "8: 'sliding' has no role 'objekt' | "
            "did you mean 'object'?\n");
  EXPECT_EQ(Mismatch("sliding(hand, hand=hand)"), "14: the role 'hand' is given twice\n");
  EXPECT_EQ(Mismatch("no contact(cup, cup)"), "16: 'cup' cannot have two roles of 'contact'\n");
  EXPECT_EQ(Mismatch("contact(any, any)"), "");
  EXPECT_EQ(Mismatch("sliding(style=wrap)"), "8: 'sliding' has no style\n");
  EXPECT_EQ(Mismatch("no sliding(hand, table)"),
            "17: 'table' is never 'object' of 'sliding', which takes a Movable | "
            "that can be cup, jug\n");
}

TEST(FitClaim, ExchangedParticipantsAreExchanged) {
  EXPECT_EQ(Mismatch("grasping(cup, hand)"),
            "9: 'cup' is never 'hand' of 'grasping', which takes a Hand | "
            "did you mean 'grasping(hand, cup)'?\n"
            "14: 'hand' is never 'object' of 'grasping', which takes a Thing | "
            "did you mean 'grasping(hand, cup)'?\n");
  EXPECT_EQ(Mismatch("grasping(cup, jug)"),
            "9: 'cup' is never 'hand' of 'grasping', which takes a Hand | that can be hand\n");
  EXPECT_EQ(Mismatch("grasping(object=table, hand=cup, style=wrap)"),
            "28: 'cup' is never 'hand' of 'grasping', which takes a Hand | that can be hand\n");
}

TEST(FitClaim, ValuesOfEventsAreNotClaimed) {
  const char* claim = "contact(hand, cup, force=jug)";
  ClaimableEvents known = StageOfClaims();
  known.events.back().attributes = {"force"};
  EXPECT_EQ(Text(Mismatches(ClaimOf(claim), known)),
            "19: 'force' is a value of 'contact'; a claim asks for roles and 'style' only | "
            "leave it out; 'prehend run' prints the values of events\n");
  EXPECT_EQ(Text(UnknownNames(ClaimOf("contact(hand, cup, force=hard)"), known)), "");
}

TEST(FitClaim, EntitiesAndStylesAreThoseOfTheScenario) {
  EXPECT_EQ(Unknown("grasping(hand, cup, style=wrap) meets sliding(any, cup)"), "");
  EXPECT_EQ(Unknown("sliding(hand, cups)"),
            "14: the scenario has no 'cups' | did you mean 'cup'?\n");
  EXPECT_EQ(Unknown("sliding(hand, spoon)"),
            "14: the scenario has no 'spoon' | known: hand, cup, jug, table\n");
  EXPECT_EQ(Unknown("grasping(style=wrop)"),
            "15: no hand of the scenario has the style 'wrop' | did you mean 'wrap'?\n");
}

}  // namespace
}  // namespace prehend::truth
