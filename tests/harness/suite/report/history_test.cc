// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "harness/suite/report/report.h"

namespace prehend::suite {
namespace {

TEST(History, KeepsTheLastRuns) {
  const std::string file = std::filesystem::temp_directory_path() /
                           ("prehend_history_" + std::to_string(getpid()) + ".jsonl");
  EXPECT_TRUE(ReadHistory(file).empty());
  ScenarioVerdict passed{.scenario = "s/a", .verdict = Verdict::kPassed, .seconds = 1.25},
      failed{.scenario = "s/b", .verdict = Verdict::kFailed, .seconds = 0.5},
      unchanged{.scenario = "s/c", .verdict = Verdict::kUnchanged};
  passed.has_golden = true;
  passed.comparison.emplace();
  passed.comparison->margins = {{.label = "x(y)", .offset = 3, .tolerance = 4}};
  std::vector<PastRun> runs;
  for (int i = 0; i < 25; ++i)
    runs.push_back(RunOf({passed, failed, unchanged}, "day " + std::to_string(i), "abc"));
  EXPECT_EQ(WriteHistory(file, runs), "");
  std::ofstream(file, std::ios::app) << "{\"date\": 5}\nnonsense\n";
  const std::vector<PastRun> read = ReadHistory(file);
  std::filesystem::remove(file);
  ASSERT_EQ(read.size(), kMostPastRuns) << "what is damaged is left out";
  EXPECT_EQ(read.front().date, "day 5");
  const auto json = HistoryJson(read);
  EXPECT_EQ(json["runs"].back(), "day 24, abc");
  EXPECT_EQ(json["of"]["s/a"][0], (nlohmann::json{0, "passed", 1.25, 2.08})) << json["of"]["s/a"];
  EXPECT_EQ(json["of"]["s/b"][19], (nlohmann::json{19, "failed", 0.5, nullptr}));
  EXPECT_FALSE(json["of"].contains("s/c")) << "it was not run";
}

}  // namespace
}  // namespace prehend::suite
