// SPDX-License-Identifier: Apache-2.0
// A scenario's state hash does not depend on what ran before it in the same process. As many runs
// as PREHEND_RUNS says, otherwise 30:
//   PREHEND_RUNS=1000 build/test/tests/harness_test --gtest_filter='OneHash.*'
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <random>
#include <set>

#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_scenario.h"

namespace prehend::episode {
namespace {

TEST(OneHash, WhateverRanBefore) {
  const char* typed = std::getenv("PREHEND_RUNS");
  const int runs = typed ? std::atoi(typed) : 30;
  const std::string root = PREHEND_SOURCE_DIR;
  std::vector<LoadedRun> loaded;
  for (const char* scenario :
       {"reach/two_candidates_one_grasped", "pick_and_place/milk_carton_wrap",
        "grasp/closing_beside_the_carton_is_no_grasp"}) {
    auto one = LoadRun({.scenario_file = root + "/scenarios/" + scenario + ".yaml",
                        .grammar = {},
                        .settings = {"settle_s=0", "script.0.right_hand.over_s=0.1"}},
                       root);
    ASSERT_TRUE(one) << Format(one.error());
    // Only the first stage: short enough to be run a thousand times, long enough to move a hand.
    one->scenario.script.stages.resize(1);
    loaded.push_back(std::move(*one));
  }
  std::mt19937 random(1);
  std::map<std::string, std::set<std::uint64_t>> hashes;
  for (int i = 0; i < runs; ++i) {
    const LoadedRun& run = loaded[random() % loaded.size()];
    hashes[run.scenario.name].insert(RunScenario(run.scenario, run.program).state_hash);
  }
  for (const auto& [name, found] : hashes) EXPECT_EQ(found.size(), 1u) << name;
  EXPECT_EQ(hashes.size(), loaded.size());
}

}  // namespace
}  // namespace prehend::episode
