// SPDX-License-Identifier: Apache-2.0
// Whole trials of a scenario that needs no hand: a ball rolls off a table, or not.
#include "harness/episode/run/run_trials.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace prehend::episode {
namespace {

const std::string kRoot = PREHEND_SOURCE_DIR;

/// A ball beside the table's edge, at x = 0.5 on average.
std::string BallFile(const std::string& outcomes) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("prehend_run_trials_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const auto path = folder / "ball.yaml";
  std::ofstream(path) << "scenario: ball\nshows: a ball is put down near an edge\nentities:\n"
                         "  table: {fixed: true, box: {size_m: [1, 1, 0.1]}, at_m: [0, 0, 0.5]}\n"
                         "  ball: {mass_kg: 0.1, sphere: {radius_m: 0.03}, at_m: [0.5, 0, 0.6]}\n"
                         "settle_s: 0.6\nvary:\n"
                         "  - {fields: [entities.ball.at_m.0], plus: [-0.1, 0.1]}\n"
                      << outcomes;
  return path.string();
}

const char* const kOutcomes =
    "outcomes:\n  stays: [{entity: ball, above_m: 0.5}]\n  falls: [{entity: ball, below_m: 0.4}]\n";

TEST(RunTrials, CountsOutcomesAndRepeats) {
  const RunRequest request{.scenario_file = BallFile(kOutcomes)};
  const auto first = RunTrials(request, kRoot, {.count = 12, .jobs = 2});
  ASSERT_TRUE(first) << grammar::Format(first.error());
  const auto again = RunTrials(request, kRoot, {.count = 12, .jobs = 1});
  int stays = 0;
  for (std::size_t i = 0; i < 12; ++i) {
    const TrialResult& result = first->results[i];
    EXPECT_EQ(result.trial, static_cast<int>(i) + 1);
    EXPECT_EQ(result.outcome, again->results[i].outcome);
    stays += result.outcome == "stays";
    // What the trial is made of says how it ends.
    const auto varied = RequestOfTrial(request, kRoot, result.trial);
    const std::string setting = varied->settings.back();
    const double x = std::stod(setting.substr(setting.find('=') + 1));
    if (std::abs(x - 0.5) > 0.01) {
      EXPECT_EQ(result.outcome, x < 0.5 ? "stays" : "falls") << setting;
    }
  }
  EXPECT_GT(stays, 1);
  EXPECT_LT(stays, 11);
}

TEST(RunTrials, TheTableNamesTheWorstAndHowToRepeatThem) {
  const std::vector<TrialResult> results = {
      {1, "stays", ""}, {2, "falls", ""}, {3, "failed", "ball: gone"}, {4, "stays", ""}};
  const auto json = TrialJson({{"stays", "falls"}, results});
  EXPECT_EQ(json["trials"], results.size());
  EXPECT_EQ(json["results"][1]["trial"], results[1].trial);
  EXPECT_EQ(json["outcomes"].size(), 4u);
  EXPECT_EQ(json["outcomes"]["stays"], std::ranges::count(results, "stays", &TrialResult::outcome));
  EXPECT_EQ(TrialTable({{"stays", "falls"}, results}, "prehend run ball"),
            "stays                        2   50.0 %\n"
            "falls                        1   25.0 %\n"
            "failed                       1   25.0 %\n"
            "trial 3: failed (ball: gone)\n"
            "  again: prehend run ball --trial 3\n"
            "trial 2: falls\n"
            "  again: prehend run ball --trial 2\n");
}

TEST(RunTrials, NeedsOutcomes) {
  const grammar::Diagnostics why = WhyNotTried({.scenario_file = BallFile("")}, kRoot);
  ASSERT_EQ(why.size(), 1u);
  EXPECT_EQ(why[0].message, "the scenario has no outcomes, so its trials cannot be classified");
}

}  // namespace
}  // namespace prehend::episode
