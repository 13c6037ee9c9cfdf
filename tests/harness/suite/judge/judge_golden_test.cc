// SPDX-License-Identifier: Apache-2.0
// A run judged by its golden and the ground truth: what holds, what differs, what waits.
#include "harness/suite/judge/judges.h"
#include "tests/harness/suite/judge/checked_run.h"

namespace prehend::suite {
namespace {

class JudgeGoldenTest : public CheckedScenario {
 protected:
  /// What a run without golden proposes, which it then agrees with.
  truth::Golden Right() const { return CompareWithGolden(std::nullopt, checked_).pending; }
  Findings Judged(const truth::Golden& golden) const {
    return JudgeGolden(CompareWithGolden(golden, checked_), checked_, "cause: ..\n");
  }

  CheckedRun checked_ = Played();
};

TEST_F(JudgeGoldenTest, WhatTheRunProposesHolds) {
  const GoldenComparison compared = CompareWithGolden(Right(), checked_);
  EXPECT_FALSE(Right().events.empty());
  EXPECT_TRUE(compared.Holds());
  EXPECT_FALSE(compared.Differs());
  EXPECT_EQ(compared.pending, Right());
  EXPECT_TRUE(Judged(Right()).empty());
}

TEST_F(JudgeGoldenTest, WithoutGoldenItIsPending) {
  const GoldenComparison compared = CompareWithGolden(std::nullopt, checked_);
  EXPECT_FALSE(compared.Holds());
  EXPECT_FALSE(compared.Differs()) << "there is nothing to differ from";
  EXPECT_EQ(compared.comparison.Count(truth::LineVerdict::kExtra),
            static_cast<int>(compared.comparison.pairings.size()));
  const Findings findings = JudgeGolden(compared, checked_, "");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].exit_code, ExitCode::kPending);
  EXPECT_EQ(findings[0].reason, "no golden yet");
  EXPECT_EQ(findings[0].details, "") << "the ground truth agrees";
  checked_.in_project = false;
  EXPECT_EQ(JudgeGolden(compared, checked_, "")[0].reason,
            "no golden: only scenarios in scenarios/ of this project have one");
}

TEST_F(JudgeGoldenTest, ADifferenceIsToldWithItsContextAndItsCause) {
  truth::Golden golden = Right();
  const std::size_t all = golden.events.size();
  golden.events.back().event.interval.begin += 12;
  const Findings findings = Judged(golden);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].exit_code, ExitCode::kDiffers);
  EXPECT_EQ(findings[0].reason, "1 of " + std::to_string(all) + " events differ from the golden");
  const std::string& details = findings[0].details;
  EXPECT_TRUE(details.starts_with("shifted supported_by(carton, table)\n")) << details;
  EXPECT_NE(details.find("\n  facts at "), std::string::npos) << details;
  EXPECT_NE(details.find("\n  why: prehend explain rest/carton_stands --event 'supported_by"),
            std::string::npos)
      << details;
  EXPECT_TRUE(details.ends_with("\ncause: ..\n")) << details;
  EXPECT_FALSE(CompareWithGolden(golden, checked_).Holds());
}

TEST_F(JudgeGoldenTest, AnotherNumberThanAcceptedDiffersFromTheGroundTruth) {
  const grammar::NamedEvent gone = checked_.result.timeline.events.back();
  checked_.result.timeline.events.pop_back();
  truth::Golden golden = Right();
  EXPECT_TRUE(Judged(golden).empty()) << "the golden counts it";
  golden.derived.clear();
  const GoldenComparison compared = CompareWithGolden(golden, checked_);
  EXPECT_FALSE(compared.Holds());
  EXPECT_FALSE(compared.Differs());
  EXPECT_EQ(compared.pending.derived.size(), 1u) << "the new count waits for review";
  Findings findings = Judged(golden);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].reason, "1 event differs from the ground truth");
  EXPECT_EQ(findings[0].details.find("ground truth: " + gone.Label()), 0u) << findings[0].details;
  golden.derived = {"oracle: 2 of 4 events follow"};
  findings = Judged(golden);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].reason, "1 event differs from the ground truth, the golden records 2");
}

}  // namespace
}  // namespace prehend::suite
