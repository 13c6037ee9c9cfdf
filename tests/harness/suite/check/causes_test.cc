// SPDX-License-Identifier: Apache-2.0
// Many failures become few causes, and passes at a limit are warned of.
#include "harness/suite/check/causes.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace prehend::suite {
namespace {

truth::Comparison Compared(grammar::Tick begin) {
  const auto event = [](grammar::Tick from) {
    return grammar::NamedEvent{
        .event = "sliding", .roles = {{"hand", "h"}, {"object", "cup"}}, .interval = {from, 200}};
  };
  truth::Golden golden{.scenario = "s/x", .grammar = "g", .ticks_per_second = 100};
  golden.events.push_back({.event = event(100), .tolerance_ms = {}, .because = {}, .comments = {}});
  return truth::Compare(golden, {.ticks_per_second = 100, .events = {event(begin)}}, 2);
}

ScenarioVerdict Failed(const std::string& id, const std::vector<Attribution>& attributions) {
  return {.scenario = id,
          .shows = {},
          .verdict = Verdict::kFailed,
          .exit_code = ExitCode::kDiffers,
          .reason = "differs",
          .comparison = Compared(150),
          .has_golden = true,
          .explain = "prehend explain " + id,
          .attributions = attributions};
}

Attribution Late(double shift_ms) {
  return {"reaching", "begins later", shift_ms, "`r` 3 -> 2 in a.grammar", "--event q"};
}

TEST(Causes, AreGroupedWithCountMedianAndOneCommand) {
  const Attribution lost = {"sliding", "missing", 0, "`s` 1 -> 5 in a.grammar", "--expected s"};
  ScenarioVerdict claim{.scenario = "s/d", .shows = {}, .verdict = Verdict::kFailed};
  claim.reason = "expects: 'no sliding' (x:4): found 1";
  claim.command = "prehend check s/d";
  const auto causes = CausesOf({Failed("s/a", {Late(120)}), Failed("s/b", {Late(71), lost}),
                                Failed("s/c", {Late(196)}), claim});
  EXPECT_EQ(CausesText(causes),
            "3 causes:\n"
            "1. `r` 3 -> 2 in a.grammar: 3 scenarios\n"
            "     3 x reaching begins later, median +120.0 ms (+71.0 to +196.0)\n"
            "     look: prehend explain s/a --event q\n"
            "2. no cause is known: s/d\n"
            "     1 x a claim does not hold\n"
            "     look: prehend check s/d\n"
            "3. `s` 1 -> 5 in a.grammar: s/b\n"
            "     1 x sliding missing\n"
            "     look: prehend explain s/b --expected s\n");
  EXPECT_EQ(CausesJson(causes)[0]["effects"][0]["median_ms"], 120);
  EXPECT_EQ(CausesText(CausesOf({})), "");
  const auto two = CausesOf({Failed("s/a", {Late(120)}), Failed("s/b", {Late(71)})});
  EXPECT_EQ(CausesJson(two)[0]["effects"][0]["median_ms"], 95.5) << "between the two";
  const Effect late =
      CausesOf({Failed("s/b", {Late(120)}), Failed("s/a", {Late(71)})})[0].effects[0];
  EXPECT_EQ(late.command, "prehend explain " + late.scenarios.front() + " --event q");
}

TEST(Causes, OfWhatNobodyCanBeAskedTheCommandRepeatsIt) {
  ScenarioVerdict heard = Failed("s/a", {Late(120)});
  heard.explain = "";
  heard.command = "prehend check s/a --recogniser r";
  EXPECT_EQ(CausesOf({heard})[0].effects[0].command, heard.command);
}

TEST(Causes, APassAtTheLimitIsAWarning) {
  const auto passed = [](const std::string& id, grammar::Tick begin) {
    ScenarioVerdict verdict{.scenario = id, .shows = {}, .verdict = Verdict::kPassed};
    verdict.comparison = Compared(begin);
    verdict.has_golden = true;
    return verdict;
  };
  EXPECT_EQ(NearLimitText(NearLimitPasses({passed("s/exact", 100), passed("s/near", 101)})), "");
  EXPECT_EQ(NearLimitText(NearLimitPasses({passed("s/exact", 100), passed("s/limit", 102)})),
            "warning: 1 scenario passed at the limit of a tolerance:\n"
            "  s/limit  begin of sliding(h, cup) is +20.0 ms off (tolerance 20.0 ms)\n");
}

}  // namespace
}  // namespace prehend::suite
