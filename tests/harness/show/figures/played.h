// SPDX-License-Identifier: Apache-2.0
// Scenarios of the project, simulated once.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_scenario.h"

namespace prehend::show {

struct Played {
  episode::LoadedRun loaded;
  episode::RunResult run;
};

inline const Played& Of(const std::string& scenario) {
  static std::map<std::string, Played> played;
  const auto [found, is_new] = played.try_emplace(scenario);
  if (is_new) {
    const std::string root = PREHEND_SOURCE_DIR;
    Result<episode::LoadedRun> loaded =
        episode::LoadRun({.scenario_file = root + "/scenarios/" + scenario + ".yaml"}, root);
    EXPECT_TRUE(loaded) << scenario;
    found->second.loaded = *loaded;
    found->second.run = episode::RunScenario(loaded->scenario, loaded->program, {.record = true});
  }
  return found->second;
}

}  // namespace prehend::show
