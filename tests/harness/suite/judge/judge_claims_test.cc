// SPDX-License-Identifier: Apache-2.0
// A run whose claims hold, and one that contradicts two of three.
#include "harness/suite/check/check_scenario.h"
#include "harness/suite/judge/judges.h"
#include "tests/harness/suite/judge/checked_run.h"

namespace prehend::suite {
namespace {

class JudgeClaimsOfARun : public CheckedScenario {
 protected:
  CheckedRun PlayedWith(const std::string& expects) const {
    Write("scenarios/rest/carton_stands.yaml", std::string(kCartonStands) + expects);
    return Played();
  }
};

TEST_F(JudgeClaimsOfARun, WithoutClaimsThereIsNothingToJudge) {
  const CheckedRun checked = PlayedWith("");
  EXPECT_TRUE(JudgeClaims(checked.loaded, checked.result.timeline).empty());
}

TEST_F(JudgeClaimsOfARun, EachContradictionIsAFinding) {
  const CheckedRun checked =
      PlayedWith("expects:\n  - no contact\n  - one supported_by(carton, table)\n  - grasping\n");
  const Findings findings = ClaimFindings(JudgeClaims(checked.loaded, checked.result.timeline));
  ASSERT_EQ(findings.size(), 2u);
  const std::string file = Request().scenario_file;
  EXPECT_EQ(findings[0].exit_code, ExitCode::kDiffers);
  EXPECT_EQ(findings[0].reason, "expects: 'no contact' (" + file + ":8): found 1");
  EXPECT_EQ(findings[0].details,
            findings[0].reason + "\n  contact(carton, table) 0.0042..0.1021 s\n");
  EXPECT_EQ(findings[1].reason, "expects: 'grasping' (" + file + ":10): found none");
  EXPECT_EQ(findings[1].details, findings[1].reason + "\n  no grasping\n");
}

/// What the physics gets wrong fails a check, unless it is expected; and so does what is expected
/// and does not happen.
TEST_F(JudgeClaimsOfARun, WhatThePhysicsGetsWrongIsExpectedOrAFinding) {
  const std::vector<physics::ScriptNote> notes = {
      {.tick = 3, .hand = {}, .text = "it is out of reach: .."},
      {.tick = 4, .hand = {}, .text = "physics: carton sinks into table: 3.0 mm deep; .."}};
  const std::string claim = "expects:\n  - sinks_into(carton, table)\n";
  const CheckedRun silent = PlayedWith(""), expecting = PlayedWith(claim);
  const Findings found = JudgeLimits(silent.loaded.scenario, notes);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].reason, notes[1].text);
  EXPECT_NE(found[0].details.find("expects: ['sinks_into(carton, table)']"), std::string::npos);
  EXPECT_TRUE(JudgeLimits(expecting.loaded.scenario, notes).empty());
  EXPECT_TRUE(JudgeClaims(expecting.loaded, expecting.result.timeline).empty());
  const auto says = [&](const std::vector<physics::ScriptNote>& noted) {
    return JudgeLimitClaims(expecting.loaded.scenario, noted).at(0).says;
  };
  EXPECT_EQ(says(notes), truth::kHolds);
  EXPECT_EQ(says({}), truth::kContradicted);
  const Findings missing = JudgeLimits(expecting.loaded.scenario, {});
  ASSERT_EQ(missing.size(), 1u);
  EXPECT_EQ(missing[0].reason,
            "expects: 'sinks_into(carton, table)' (" + Request().scenario_file + ":8): found none");
  EXPECT_TRUE(JudgeLimits(silent.loaded.scenario, silent.result.notes).empty());
}

}  // namespace
}  // namespace prehend::suite
