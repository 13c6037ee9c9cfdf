// SPDX-License-Identifier: Apache-2.0
// A run that keeps the invariants, and one that does not.
#include "harness/suite/judge/judges.h"
#include "tests/harness/suite/judge/checked_run.h"

namespace prehend::suite {
namespace {

using JudgeInvariantsTest = CheckedScenario;

TEST_F(JudgeInvariantsTest, ARunThatKeepsThemHasNoFindings) {
  EXPECT_TRUE(JudgeInvariants(Played()).empty());
}

TEST_F(JudgeInvariantsTest, EachViolationIsALine) {
  CheckedRun checked = Played();
  for (grammar::NamedEvent& event : checked.result.timeline.events)
    event.decided += 10 * checked.result.timeline.ticks_per_second;
  const Findings findings = JudgeInvariants(checked);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].exit_code, ExitCode::kDiffers);
  EXPECT_EQ(findings[0].reason, "invariant violated");
  const std::string& details = findings[0].details;
  EXPECT_EQ(static_cast<std::size_t>(std::count(details.begin(), details.end(), '\n')),
            checked.result.timeline.events.size());
  EXPECT_NE(details.find("violated: decisions_come_in_time at 10."), std::string::npos) << details;
  EXPECT_NE(details.find("supported_by(carton, table) was decided at 10."), std::string::npos)
      << details;
}

}  // namespace
}  // namespace prehend::suite
