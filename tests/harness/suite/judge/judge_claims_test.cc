// SPDX-License-Identifier: Apache-2.0
// A run whose claims hold, and one that contradicts two of three.
#include "harness/suite/check/check_scenario.h"
#include "harness/suite/judge/judge.h"
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

}  // namespace
}  // namespace prehend::suite
