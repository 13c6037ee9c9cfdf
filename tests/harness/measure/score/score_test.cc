// SPDX-License-Identifier: Apache-2.0
// Scores over several episodes: what is pooled, what is a mean, and what an absent grammar costs.
#include "harness/measure/score/score.h"

#include <gtest/gtest.h>

namespace prehend::measure {
namespace {

grammar::NamedEvent Event(const std::string& event, grammar::Tick begin, grammar::Tick end,
                          grammar::Tick decided) {
  return {
      .event = event, .roles = {{"object", "cup"}}, .interval = {begin, end}, .decided = decided};
}

EpisodeToScore Episode(std::vector<grammar::NamedEvent> truth,
                       std::vector<grammar::NamedEvent> found, grammar::Tick per_s = 100) {
  return {"s/x", 1000, {per_s, std::move(truth)}, {per_s, std::move(found)}, {}};
}

TEST(ScoreOf, BoundaryErrorsAreSignedAndLatencyIsFromTheEnd) {
  std::vector<EpisodeToScore> episodes;
  for (int late = -4; late <= 1; ++late)
    episodes.push_back(
        Episode({Event("slide", 100, 300, 0)}, {Event("slide", 100 + late, 300, 300 - 5 * late)}));
  const Score score = ScoreOf("g", episodes, 0.05);
  EXPECT_DOUBLE_EQ(score.total.begin.Median(), -0.015) << "of six: between -0.02 and -0.01";
  EXPECT_DOUBLE_EQ(score.total.begin.QuantileByMagnitude(1), -0.04) << "the largest keeps its sign";
  EXPECT_DOUBLE_EQ(score.total.end.QuantileByMagnitude(1), 0);
  EXPECT_DOUBLE_EQ(score.total.late.QuantileByMagnitude(1), 0.2);
  EXPECT_NE(ScoreTable(score).find("-15/-40/-40   0/0/0"), std::string::npos) << ScoreTable(score);
}

TEST(ScoreOf, WhatIsNotSaidIsMissed) {
  std::vector<EpisodeToScore> episodes = {Episode(
      {Event("slide", 100, 300, 0), Event("hold", 50, 400, 0)}, {Event("hold", 50, 400, 400)})};
  episodes[0].ignored["slidding"] = 3;
  Score score = ScoreOf("g", episodes, 0.05);
  score.not_covered = {"slide"};
  EXPECT_EQ(score.total.truths, 2);
  EXPECT_EQ(score.total.ward.deleted, 1);
  EXPECT_NEAR(score.total.overlap_50.F1(), 2.0 / 3, 1e-12);
  const std::string table = ScoreTable(score);
  EXPECT_TRUE(table.ends_with(
      "\nnot covered: slide (1 true); no rule of the grammar prints them, so they count as missed\n"
      "ignored: slidding (3 found); docs/events.md does not define them\n"))
      << table;
}

TEST(ScoreOf, FurtherScoresAreFullForTheTruthAndFallWithEveryMistake) {
  const std::vector<grammar::NamedEvent> truth = {Event("slide", 100, 300, 0),
                                                  Event("slide", 500, 700, 0)};
  const FurtherScores full =
      ScoreOf("g", {Episode(truth, truth), Episode(truth, truth, 200)}, 0.05).total.further;
  for (const double share : {full.map_50, full.boundary_hits.F1(), full.pairwise_f1, full.purity,
                             full.coverage, full.intersection_f1, full.psds})
    EXPECT_EQ(share, 1);
  EXPECT_EQ(full.deviation_from_truth_s, 0);

  const FurtherScores merged =
      ScoreOf("g", {Episode(truth, {Event("slide", 100, 700, 700)})}, 0.05).total.further;
  EXPECT_EQ(merged.map_50, 0) << "a third of the merged event is true of either";
  EXPECT_EQ(merged.boundary_hits.correct, 2);
  EXPECT_EQ(merged.boundary_hits.missed, 2);
  EXPECT_DOUBLE_EQ(merged.deviation_from_truth_s, 1.0) << "0, 2, 2 and 0 s";
  EXPECT_DOUBLE_EQ(merged.purity, 0.6) << "0.1 + 0.2 + 0.3 of the frames";
  EXPECT_DOUBLE_EQ(merged.coverage, 1.0) << "each true piece lies in one that was found";
  EXPECT_LT(merged.pairwise_f1, 1);
  EXPECT_EQ(merged.intersection_f1, 1) << "two thirds of it are true, and it covers both";

  const FurtherScores invented =
      ScoreOf("g", {Episode({truth[0]}, {truth[0], Event("slide", 500, 700, 700)})}, 0.05)
          .total.further;
  EXPECT_EQ(invented.psds, 0) << "one false event in 10 s are 360 in an hour";
}

TEST(ScoreOf, WhereNothingIsTrueWhatIsFoundIsNoSuccess) {
  const Score nothing = ScoreOf("g", {Episode({}, {})}, 0.05),
              wrong = ScoreOf("g", {Episode({}, {Event("slide", 100, 300, -1)})}, 0.05);
  for (const auto& [score, share] : {std::pair{nothing, 1}, std::pair{wrong, 0}}) {
    const FurtherScores& further = score.total.further;
    for (const double one : {further.map_50, further.intersection_f1, further.psds})
      EXPECT_EQ(one, share);
  }
  // No numbers are null.
  const auto total = ScoresJson({wrong})["grammars"][0]["total"];
  for (const char* times : {"begin_s", "end_s", "latency_s"})
    for (const char* figure : {"median", "p95", "max"})
      EXPECT_TRUE(total[times][figure].is_null()) << times << figure;
  // As it is written: NaN is null.
  EXPECT_EQ(total["further"]["boundary_deviation_s"].dump(),
            R"({"from_truth":null,"from_found":null})");
}

}  // namespace
}  // namespace prehend::measure
