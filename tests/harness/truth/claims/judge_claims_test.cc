// SPDX-License-Identifier: Apache-2.0
// What each form of a claim means.
#include "harness/truth/claims/judge_claims.h"

#include "tests/harness/truth/claims/claimed_stage.h"

namespace prehend::truth {
namespace {

/// Two grasps of the cup with a slide in each, the first up to its end; the jug is only touched.
grammar::Timeline Story() {
  return {.ticks_per_second = 100,
          .events = {Happened("contact", "cup", "hand", {90, 500}),
                     Happened("grasping", "hand", "cup", {100, 200}, "wrap"),
                     Happened("sliding", "hand", "cup", {150, 200}),
                     Happened("contact", "hand", "jug", {200, 300}),
                     Happened("grasping", "hand", "cup", {300, 400}, "wrap"),
                     Happened("sliding", "hand", "cup", {320, 340})}};
}

ClaimVerdict Judged(const std::string& text) {
  Claim claim = ClaimOf(text);
  claim.where.place = {4, 5};
  return JudgeClaims({claim}, "x.yaml", StageOfClaims(), Story()).at(0);
}
std::string Says(const std::string& claim) {
  const ClaimVerdict verdict = Judged(claim);
  return verdict.says + ": " + verdict.found;
}

TEST(JudgeClaims, CountsWhatFits) {
  EXPECT_EQ(Says("grasping"), "holds: found 2");
  EXPECT_EQ(Says("2 grasping(hand, cup)"), "holds: found 2");
  EXPECT_EQ(Says("one grasping(hand, cup)"), "contradicted: found 2");
  EXPECT_EQ(Says("3 grasping"), "contradicted: found 2");
  EXPECT_EQ(Says("at least 2 grasping"), "holds: found 2");
  EXPECT_EQ(Says("at least 3 grasping"), "contradicted: found 2");
  EXPECT_EQ(Says("at most 2 grasping"), "holds: found 2");
  EXPECT_EQ(Says("at most one grasping"), "contradicted: found 2");
  EXPECT_EQ(Says("no grasping(hand, jug)"), "holds: found none");
  EXPECT_EQ(Says("grasping(hand, jug)"), "contradicted: found none");
  EXPECT_EQ(Says("no sliding"), "contradicted: found 2");
}

TEST(JudgeClaims, CountsWhatLiesSo) {
  EXPECT_EQ(Says("sliding finishes grasping"), "holds: found 1 of 2");
  EXPECT_EQ(Says("one sliding inside grasping"), "holds: found 1 of 2");
  EXPECT_EQ(Says("2 sliding lies inside grasping"), "holds: found 2 of 2");
  EXPECT_EQ(Says("every sliding lies inside grasping"), "holds: found 2 of 2");
  EXPECT_EQ(Says("every sliding finishes grasping"), "contradicted: found 1 of 2");
  EXPECT_EQ(Says("every sliding(hand, jug) finishes grasping"), "contradicted: found none");
  EXPECT_EQ(Says("no grasping meets sliding"), "holds: found 0 of 2");
  EXPECT_EQ(Says("grasping meets contact(hand, jug) meets grasping"), "holds: found 1 of 2");
  EXPECT_EQ(Says("grasping then grasping then grasping"), "contradicted: found 0 of 2");
  EXPECT_EQ(Says("grasping before grasping"), "holds: found 1 of 2");
  EXPECT_EQ(Says("contact(jug, hand) while grasping"), "contradicted: found 0 of 1");
  EXPECT_EQ(Says("contact(jug, hand) while contact(cup, hand)"), "holds: found 1 of 1");
}

TEST(JudgeClaims, AnEventDoesNotLieToItself) {
  EXPECT_EQ(Says("no grasping equals grasping"), "holds: found 0 of 2");
  EXPECT_EQ(Says("no contact(hand, jug) while contact(jug, hand)"), "holds: found 0 of 1");
}

TEST(JudgeClaims, WhatAnotherGrammarLacksIsNotJudged) {
  const ClaimVerdict verdict = Judged("no opening(cup)");
  EXPECT_EQ(verdict.says, kNotJudged);
  EXPECT_FALSE(IsContradicted(verdict));
  EXPECT_EQ(TextOfUndecided({verdict}),
            "expects: 'no opening(cup)' (x.yaml:4): not judged: "
            "grammar 'stage' has no event 'opening'\n");
  EXPECT_EQ(TextOfContradicted({verdict}), "");
}

TEST(JudgeClaims, AContradictionShowsWhatWasFoundAndWhen) {
  EXPECT_EQ(TextOfContradicted({Judged("no sliding"), Judged("grasping"),
                                Judged("grasping(any, jug) meets contact(hand, jug)")}),
            "expects: 'no sliding' (x.yaml:4): found 2\n"
            "  sliding(hand, cup) 1.5000..2.0000 s\n"
            "  sliding(hand, cup) 3.2000..3.4000 s\n"
            "expects: 'grasping(any, jug) meets contact(hand, jug)' (x.yaml:4): found none\n"
            "  no grasping(any, jug), but of others:\n"
            "  grasping(hand, cup) 1.0000..2.0000 s\n"
            "  grasping(hand, cup) 3.0000..4.0000 s\n"
            "  contact(hand, jug) 2.0000..3.0000 s\n");
}

TEST(JudgeClaims, LongListsAreCut) {
  grammar::Timeline timeline{.ticks_per_second = 100, .events = {}};
  for (int i = 0; i < 22; ++i)
    timeline.events.push_back(Happened("sliding", "hand", "cup", {10 * i, 10 * i + 1}));
  const auto verdicts = JudgeClaims({ClaimOf("no sliding")}, "x.yaml", StageOfClaims(), timeline);
  EXPECT_TRUE(verdicts[0].times.ends_with("1.9100 s\n  and 2 more\n")) << verdicts[0].times;
}

}  // namespace
}  // namespace prehend::truth
