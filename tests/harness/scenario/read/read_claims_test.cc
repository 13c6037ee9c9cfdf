// SPDX-License-Identifier: Apache-2.0
// Claims keep the place where they were written, and errors in them point at the letter.
#include <gtest/gtest.h>

#include "harness/scenario/read/read_parts.h"
#include "tests/harness/scenario_fixture.h"

namespace prehend::scenario {
namespace {

Result<Scenario> ReadWith(const std::string& expects,
                          const std::vector<std::string>& overrides = {}) {
  const std::string shows = "shows: a carton on a table\n";
  return ReadScenarioText("probe.yaml", ProbeWith(shows, shows + expects), overrides,
                          ProbeLibrary());
}

TEST(ReadClaims, EachKnowsItsPlace) {
  const auto scenario = ReadWith(
      "expects:\n  - no sliding\n  - \"one grasping(right_hand, milk)\"\n"
      "  - reaching(right_hand, milk)\n    then grasping\n");
  ASSERT_TRUE(scenario) << Format(scenario.error());
  ASSERT_EQ(scenario->expects.size(), 3u);
  const auto place = [&](std::size_t i, std::size_t offset) {
    const Where where = truth::PlaceIn(scenario->expects[i], offset);
    return std::pair(where.place.line, where.place.column);
  };
  EXPECT_EQ(place(0, 3), std::pair(4, 8));
  EXPECT_EQ(place(1, 4), std::pair(5, 10)) << "the quote is no part of it";
  EXPECT_EQ(place(2, 20), std::pair(6, 5)) << "on several lines only its begin is known";
  EXPECT_EQ(scenario->expects[2].text, "reaching(right_hand, milk) then grasping");
}

TEST(ReadClaims, ErrorsPointAtTheLetter) {
  EXPECT_EQ(Brief(ErrorsOf(ReadWith("expects:\n  - no sliding(\n  - one\n"))),
            "4:16: expects: expected an entity or 'any', found the end\n"
            "5:8: expects: expected an event, found the end\n");
  EXPECT_EQ(Brief(ErrorsOf(ReadWith("expects: ['no sliding', 'grasping meet sliding']\n"))),
            "3:35: expects: expected 'then', 'while', 'lies inside' or one of Allen's relations, "
            "found 'meet' | did you mean 'meets'?\n");
  EXPECT_EQ(Brief(ErrorsOf(ReadWith("", {"expects=[no sliding, one]"}))),
            "--set:1:25: expects: expected an event, found the end\n");
}

// YAML splits it there; what it makes of the pieces is not the mistake.
TEST(ReadClaims, ACommaInBracketsNeedsQuotes) {
  EXPECT_EQ(Brief(ErrorsOf(
                ReadWith("expects: [no sliding, one grasping(right_hand, milk), sliding(]\n"))),
            "3:23: expects: the comma of a claim ends it in '[..]' | with quotes: \"one "
            "grasping(right_hand, milk)\", or one claim per line, each after '- '\n"
            "3:63: expects: expected an entity or 'any', found the end\n");
}

TEST(ReadClaims, HaveLimits) {
  std::string many = "expects:\n";
  for (int i = 0; i < 65; ++i) many += "  - no sliding\n";
  EXPECT_EQ(Brief(ErrorsOf(ReadWith(many))), "4:3: expects: expected at most 64 items, found 65\n");
}

}  // namespace
}  // namespace prehend::scenario
