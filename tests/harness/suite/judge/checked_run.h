// SPDX-License-Identifier: Apache-2.0
// A project folder with one short scenario, and its run as judges are given it. Tested by what uses
// it.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "harness/base/base/atomic_file.h"
#include "harness/suite/judge/judges.h"

namespace prehend::suite {

inline constexpr const char* kCartonStands = R"(scenario: carton_stands
shows: a carton stands on a table
entities:
  table: {class: Table, fixed: true, box: {size_m: [1.2, 0.8, 0.04]}, at_m: [0, 0, 0.74]}
  carton: {class: Carton, box: {size_m: [0.06, 0.06, 0.10]}, mass_kg: 0.3, on: table, at_m: [0.15, 0.15]}
settle_s: 0.1
)";

class CheckedScenario : public testing::Test {
 protected:
  CheckedScenario() {
    std::filesystem::remove_all(root_);
    std::filesystem::create_directories(root_);
    for (const char* library : {"grammar", "physics"})
      std::filesystem::create_directory_symlink(std::filesystem::path(PREHEND_SOURCE_DIR) / library,
                                                root_ / library);
    Write("scenarios/rest/carton_stands.yaml", kCartonStands);
  }
  ~CheckedScenario() override { std::filesystem::remove_all(root_); }

  std::string Write(const std::string& file, const std::string& text) const {
    EXPECT_EQ(WriteTextFile(root_ / file, text, Over::kAnything), "");
    return (root_ / file).string();
  }

  episode::RunRequest Request() const {
    return {.scenario_file = (root_ / "scenarios/rest/carton_stands.yaml").string(),
            .grammar = {},
            .settings = {}};
  }

  CheckedRun Played() const {
    auto loaded = episode::LoadRun(Request(), root_.string());
    EXPECT_TRUE(loaded) << Format(loaded.error());
    CheckedRun checked{.id = "rest/carton_stands",
                       .loaded = std::move(*loaded),
                       .result = {},
                       .explain = "prehend explain rest/carton_stands"};
    checked.result =
        episode::RunScenario(checked.loaded.scenario, checked.loaded.program, {.record = true});
    return checked;
  }

  const std::filesystem::path root_ =
      std::filesystem::path(testing::TempDir()) /
      ("checked_" + std::to_string(getpid()) + "_" +
       std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

}  // namespace prehend::suite
