// SPDX-License-Identifier: Apache-2.0
// Scenarios of the project, simulated once.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "harness/run/load_run.h"
#include "harness/run/run_scenario.h"

namespace prehend::harness::figures {

struct Played {
  LoadedRun loaded;
  RunResult run;
};

inline const Played& Of(const std::string& scenario) {
  static std::map<std::string, Played> played;
  const auto [found, is_new] = played.try_emplace(scenario);
  if (is_new) {
    const std::string root = PREHEND_SOURCE_DIR;
    Result<LoadedRun> loaded =
        LoadRun({.scenario_file = root + "/scenarios/" + scenario + ".yaml"}, root);
    EXPECT_TRUE(loaded) << scenario;
    found->second.loaded = *loaded;
    found->second.run = RunScenario(loaded->scenario, loaded->program, {.record = true});
  }
  return found->second;
}

}  // namespace prehend::harness::figures
