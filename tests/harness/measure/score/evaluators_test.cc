// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "harness/measure/score/further_scores.h"

namespace prehend::measure {
namespace {

using grammar::Interval;
using grammar::Timeline;

Timeline Of(const std::vector<std::pair<std::string, Interval>>& events) {
  Timeline timeline{.ticks_per_second = 480, .events = {}};
  for (const auto& [event, interval] : events)
    timeline.events.push_back({.event = event, .roles = {{"hand", "h"}}, .interval = interval});
  return timeline;
}

TEST(ByDefinitions, CountsWhatLiesInTheBandsAndNamesTheRest) {
  const std::vector<Timeline> possible = {
      Of({{"grasping", {480, 960}}, {"sliding", {480, 960}}, {"lifting", {1000, 1100}}}),
      Of({{"grasping", {432, 960}}, {"sliding", {480, 960}}, {"lifting", {1000, 1100}}})};
  const Timeline found =
      Of({{"grasping", {450, 960}}, {"sliding", {480, 1200}}, {"waving", {1440, 1920}}});
  const Evaluation evaluation = ByDefinitions("slide/x", possible, found, 4);
  EXPECT_EQ(evaluation.Total().of, 4);
  EXPECT_EQ(evaluation.Total().confirmed, 1);
  EXPECT_EQ(evaluation.by_event.at("grasping").confirmed, 1);
  EXPECT_EQ(evaluation.differences,
            (std::vector<std::string>{
                "slide/x  lifting(h)  not recognised, by the definitions 2.0833..2.2917 s",
                "slide/x  sliding(h)  recognised 1.0000..2.5000 s, by the definitions "
                "1.0000..2.0000 s",
                "slide/x  waving(h)  recognised 3.0000..4.0000 s, not by the definitions"}));
}

TEST(ByClaims, LeavesOutWhatAGrammarCannotDecide) {
  const std::vector<truth::ClaimVerdict> verdicts = {
      {.claim = "no sliding", .place = "x.yaml:4", .says = truth::kHolds},
      {.claim = "one waving", .place = "x.yaml:5", .says = truth::kNotJudged},
      {.claim = "2 grasping",
       .place = "x.yaml:6",
       .says = truth::kContradicted,
       .found = "found 3"}};
  const Evaluation evaluation = ByClaims("slide/x", verdicts);
  EXPECT_EQ(evaluation.Total().of, 2);
  EXPECT_EQ(evaluation.Total().confirmed, 1);
  EXPECT_EQ(evaluation.differences,
            (std::vector<std::string>{"slide/x  expects: '2 grasping' (x.yaml:6): found 3"}));
}

TEST(EvaluatorTable, HasARowPerEvaluator) {
  Evaluation most;
  most.by_event["sliding"] = {.of = 8, .confirmed = 7};
  EXPECT_EQ(
      EvaluatorTable({"mine", "theirs"}, {{"definitions", "it follows from the page", {most, {}}}}),
      "| evaluator | mine | theirs | what it proves |\n"
      "|---|---|---|---|\n"
      "| definitions | 7 of 8 (87.5 %) | - | it follows from the page |\n");
}

}  // namespace
}  // namespace prehend::measure
