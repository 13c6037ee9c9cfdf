// SPDX-License-Identifier: Apache-2.0
// The order of judging, and what a check leaves behind.
#include "harness/suite/check/check_scenario.h"

#include "harness/suite/check/last_pass.h"
#include "harness/suite/judge/judges.h"
#include "harness/suite/judge/validate_golden.h"
#include "harness/truth/golden/golden.h"
#include "tests/harness/episode/run/count_reads.h"
#include "tests/harness/suite/judge/checked_run.h"

namespace prehend::suite {
namespace {

namespace fs = std::filesystem;

constexpr const char* kId = "rest/carton_stands";

class CheckScenarioTest : public CheckedScenario {
 protected:
  CheckRequest Check() const {
    return {.episode = {.file = Request().scenario_file, .scenario = kId},
            .id = kId,
            .root = root_.string(),
            .report_folder = (root_ / "build/report").string(),
            .pictures = false};
  }
  void Accept() const {
    ASSERT_EQ(files_.WriteGoldenFile(CompareWithGolden(std::nullopt, Played()).pending), "");
  }
  bool LeftTrace() const { return fs::exists(LastPasses(root_).TracePath(kId)); }

  const truth::GoldenFiles files_{root_};
};

TEST_F(CheckScenarioTest, AScenarioThatAgreesPassesAndLeavesItsTrace) {
  Accept();
  ProgressCounters ticks(1);
  CheckRequest request = Check();
  request.last_tick = &ticks[0];
  const ScenarioVerdict verdict = CheckScenario(request);
  EXPECT_EQ(verdict.verdict, Verdict::kPassed) << verdict.details;
  EXPECT_EQ(verdict.exit_code, ExitCode::kAgrees);
  EXPECT_EQ(verdict.reason + verdict.details + verdict.cause, "");
  EXPECT_TRUE(verdict.has_golden && verdict.comparison->Agrees());
  EXPECT_EQ(verdict.shows, "a carton stands on a table");
  EXPECT_EQ(verdict.command, "prehend check rest/carton_stands");
  EXPECT_EQ(ticks[0], verdict.ticks) << "it has reported how far it came";
  EXPECT_EQ(verdict.inputs.count(files_.GoldenPath(kId).string()), 1u);
  EXPECT_TRUE(LeftTrace());
  EXPECT_FALSE(fs::exists(files_.PendingPath(kId)));
}

TEST_F(CheckScenarioTest, AScenarioIsReadOnceAndHashedOnce) {
  Accept();
  const episode::CountReads reads(Request().scenario_file);
  EXPECT_EQ(CheckScenario(Check()).verdict, Verdict::kPassed);
  EXPECT_EQ(reads.Count(), 2);
}

TEST_F(CheckScenarioTest, WithoutGoldenItIsPendingAndItsProposalWaits) {
  const ScenarioVerdict verdict = CheckScenario(Check());
  EXPECT_EQ(verdict.verdict, Verdict::kPending);
  EXPECT_EQ(verdict.exit_code, ExitCode::kPending);
  EXPECT_EQ(verdict.reason, "no golden yet");
  EXPECT_EQ(verdict.command, "prehend review rest/carton_stands");
  EXPECT_FALSE(verdict.has_golden);
  ASSERT_TRUE(files_.ReadPendingOf(kId).value().has_value());
  EXPECT_FALSE(LeftTrace());
  Accept();
  EXPECT_EQ(CheckScenario(Check()).verdict, Verdict::kPassed);
  EXPECT_FALSE(fs::exists(files_.PendingPath(kId))) << "nothing waits any more";
}

TEST_F(CheckScenarioTest, ADifferenceFailsWithItsCauseAndLeavesAProposal) {
  Accept();
  CheckScenario(Check());
  ASSERT_EQ(LastPasses(root_).Write({.program = "p", .verdict = CheckScenario(Check())}), "");
  truth::Golden golden = *files_.ReadGoldenOf(kId).value();
  golden.events.pop_back();
  ASSERT_EQ(files_.WriteGoldenFile(golden), "");
  CheckRequest request = Check();
  request.program = "p";
  const ScenarioVerdict verdict = CheckScenario(request);
  EXPECT_EQ(verdict.verdict, Verdict::kFailed);
  EXPECT_EQ(verdict.exit_code, ExitCode::kDiffers);
  EXPECT_TRUE(verdict.DiffersFromGolden());
  EXPECT_EQ(verdict.cause,
            "cause: the grammar or the golden. Everything moves as in the last passing run. "
            "Changed since: golden/rest/carton_stands.timeline\n");
  EXPECT_TRUE(verdict.details.ends_with(verdict.cause)) << verdict.details;
  EXPECT_TRUE(fs::exists(files_.PendingPath(kId)));
}

TEST_F(CheckScenarioTest, ATrialLeavesNothingBehind) {
  CheckRequest request = Check();
  request.leave_nothing_behind = true;
  EXPECT_EQ(CheckScenario(request).verdict, Verdict::kPending);
  Accept();
  EXPECT_EQ(CheckScenario(request).verdict, Verdict::kPassed);
  EXPECT_FALSE(fs::exists(root_ / "build"));
  ASSERT_EQ(files_.WritePending(*files_.ReadGoldenOf(kId).value()), "");
  EXPECT_EQ(CheckScenario(request).verdict, Verdict::kPassed);
  EXPECT_TRUE(fs::exists(files_.PendingPath(kId))) << "nor does it take anything away";
}

TEST_F(CheckScenarioTest, WhatCannotBeReadIsBadInput) {
  CheckRequest request = Check();
  request.changes.settings = {"settle_s=soon"};
  const ScenarioVerdict scenario = CheckScenario(request);
  EXPECT_EQ(scenario.exit_code, ExitCode::kBadInput);
  EXPECT_EQ(scenario.reason, "cannot be read");
  EXPECT_EQ(scenario.command, "prehend validate rest/carton_stands --set settle_s=soon");
  EXPECT_FALSE(scenario.comparison);

  Write("golden/rest/carton_stands.timeline", "no golden\n");
  const ScenarioVerdict golden = CheckScenario(Check());
  EXPECT_EQ(golden.verdict, Verdict::kFailed);
  EXPECT_EQ(golden.exit_code, ExitCode::kBadInput);
  EXPECT_EQ(golden.reason, "the golden cannot be read");
  ASSERT_EQ(golden.errors.size(), 1u);
  EXPECT_TRUE(golden.errors[0].file.ends_with("rest/carton_stands.timeline"));
  EXPECT_EQ(golden.errors[0].place.line, 1);
  EXPECT_FALSE(golden.comparison);
  EXPECT_FALSE(fs::exists(files_.PendingPath(kId)));
}

TEST_F(CheckScenarioTest, WhatIsWrongComesBeforeAGoldenThatDoesNotExist) {
  Write("golden/rest/carton_stands.png", "");
  const ScenarioVerdict verdict = CheckScenario(Check());
  EXPECT_EQ(verdict.verdict, Verdict::kFailed);
  EXPECT_EQ(verdict.exit_code, ExitCode::kDiffers);
  EXPECT_EQ(verdict.reason, "a golden picture that the scenario does not ask for");
  EXPECT_TRUE(fs::exists(files_.PendingPath(kId))) << "the proposal waits all the same";
}

TEST_F(CheckScenarioTest, ItsCommandsRepeatGrammarAndSettings) {
  EXPECT_EQ(ExplainCommand({.changes = {"my rules.grammar", {"lift_rise=10cm"}}, .id = "a/b"}),
            "prehend explain a/b --grammar 'my rules.grammar' --set lift_rise=10cm");
  EXPECT_EQ(RepeatCommand({.id = "a/b"}), "prehend check a/b");
}

}  // namespace
}  // namespace prehend::suite
