// SPDX-License-Identifier: Apache-2.0
// A verdict survives its way from the worker, and the worst one decides how a check ends.
#include "harness/check/verdict.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace prehend::harness {
namespace {

TEST(Verdict, TravelsAsJson) {
  const ScenarioVerdict verdict{.scenario = "slide/x",
                                .shows = "a \"slide\"",
                                .verdict = Verdict::kPending,
                                .exit_code = ExitCode::kPending,
                                .reason = "no golden yet",
                                .details = "a\nb\n",
                                .differences = {{{"kind", "missing"}, {"begin_ms", nullptr}}},
                                .relations = {{{"first", "a"}}},
                                .blame = "blame: physics\n",
                                .headroom = "h",
                                .boundaries = {{"begin of x", -1.5, 8.25}},
                                .command = "prehend accept slide/x",
                                .state_hash = "0x1",
                                .ticks = 5,
                                .seconds = 0.25,
                                .peak_memory_kib = 9,
                                .inputs = {{"a.yaml", "0123"}},
                                .pictures = {{"p.png", "caption"}},
                                .timeline_svg = "<svg/>"};
  const auto json = ToJson(verdict);
  EXPECT_EQ(json["verdict"], "pending");
  EXPECT_EQ(ToJson(VerdictFromJson(nlohmann::ordered_json::parse(json.dump()))), json);
}

struct Case {
  std::vector<ExitCode> codes;
  ExitCode worst;
};

TEST(Verdict, TheWorstDecides) {
  const std::vector<Case> cases = {
      {{}, ExitCode::kNothing},
      {{ExitCode::kAgrees, ExitCode::kAgrees}, ExitCode::kAgrees},
      {{ExitCode::kAgrees, ExitCode::kPending}, ExitCode::kPending},
      {{ExitCode::kPending, ExitCode::kDiffers}, ExitCode::kDiffers},
      {{ExitCode::kBadInput, ExitCode::kDiffers}, ExitCode::kBadInput},
      {{ExitCode::kDiffers, ExitCode::kFailure, ExitCode::kBadInput}, ExitCode::kFailure},
  };
  for (const Case& row : cases) {
    std::vector<ScenarioVerdict> verdicts;
    for (const ExitCode code : row.codes) verdicts.push_back({.exit_code = code});
    EXPECT_EQ(WorstOf(verdicts), row.worst);
  }
}

TEST(Verdict, AreCounted) {
  const Tally tally = Count({{.verdict = Verdict::kPassed},
                             {.verdict = Verdict::kFailed},
                             {.verdict = Verdict::kPassed}});
  EXPECT_EQ(tally.passed, 2);
  EXPECT_EQ(tally.failed, 1);
  EXPECT_EQ(tally.pending, 0);
}

TEST(Verdict, TheLeastHeadroomOfAllIsTold) {
  ScenarioVerdict exact{.scenario = "a/exact", .shows = {}}, near = exact, nearer = exact;
  EXPECT_EQ(LeastHeadroomText({exact}), "");
  exact.boundaries = {{"begin of x", 0, 1}};
  EXPECT_EQ(LeastHeadroomText({exact}), "") << "what is exact needs no headroom";
  near.boundaries = {{"begin of x", 0, 8}, {"end of x", -2, 8}};
  nearer.scenario = "b/near";
  nearer.boundaries = {{"end of y", 5, 10}};
  EXPECT_EQ(LeastHeadroomText({exact, near, nearer}),
            "least headroom: 5.0 of 10.0 ms are left at end of y of b/near");
}

TEST(Verdict, RepeatsThatAgreeAreOneVerdict) {
  ScenarioVerdict run{.scenario = "a/b", .shows = {}, .verdict = Verdict::kPassed};
  run.state_hash = "0x1";
  std::vector<ScenarioVerdict> runs(3, run);
  runs[1].seconds = 2;
  runs[2].peak_memory_kib = 7;
  const ScenarioVerdict merged = MergeRepeats(runs);
  EXPECT_EQ(merged.verdict, Verdict::kPassed);
  EXPECT_EQ(merged.seconds, 2);
  EXPECT_EQ(merged.peak_memory_kib, 7);
}

TEST(Verdict, RepeatsThatDifferAreFlaky) {
  ScenarioVerdict run{.scenario = "a/b", .shows = {}, .verdict = Verdict::kPassed};
  run.state_hash = "0x1";
  std::vector<ScenarioVerdict> runs(3, run);
  runs[1].state_hash = "0x2";
  EXPECT_EQ(MergeRepeats(runs).verdict, Verdict::kFlaky);
  EXPECT_EQ(MergeRepeats(runs).exit_code, ExitCode::kDiffers);
  EXPECT_EQ(MergeRepeats(runs).reason, "flaky: of 3 runs 3 passed; 2 different state hashes");

  runs[1].verdict = Verdict::kFailed;
  runs[1].state_hash = "";
  runs[1].exit_code = ExitCode::kFailure;
  runs[1].details = "what the failed one said";
  EXPECT_EQ(MergeRepeats(runs).exit_code, ExitCode::kFailure);
  EXPECT_EQ(MergeRepeats(runs).reason, "flaky: of 3 runs 1 failed, 2 passed");
  EXPECT_EQ(MergeRepeats(runs).details, "what the failed one said");
  EXPECT_EQ(Count({MergeRepeats(runs)}).failed, 1);
}

TEST(Verdict, APictureThatDiffersFailsWithoutBeingFlaky) {
  std::vector<ScenarioVerdict> runs(2);
  for (ScenarioVerdict& run : runs) run.verdict = Verdict::kPassed;
  runs[1].picture_differences =
      "picture x.png: 5 % differ\n";  // the first of them to end drew nothing
  const ScenarioVerdict merged = MergeRepeats(runs);
  EXPECT_EQ(merged.verdict, Verdict::kFailed);
  EXPECT_EQ(merged.exit_code, ExitCode::kDiffers);
  EXPECT_EQ(merged.reason, "a picture differs from its golden");
  EXPECT_EQ(merged.details, "picture x.png: 5 % differ\n");
  runs[0].verdict = Verdict::kFailed;
  EXPECT_EQ(MergeRepeats(runs).verdict, Verdict::kFlaky);
  EXPECT_EQ(VerdictFromJson(ToJson(runs[1])).picture_differences, runs[1].picture_differences);
}

}  // namespace
}  // namespace prehend::harness
