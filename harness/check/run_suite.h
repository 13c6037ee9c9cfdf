// SPDX-License-Identifier: Apache-2.0
// Many scenarios, each in a process of its own, several at a time: slowest first, repeated if asked
// for, without those that nothing changed for. Tested by tests/program/runner_test.cc
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/check/select_scenarios.h"
#include "harness/check/verdict.h"
#include "harness/process/worker_pool.h"
#include "harness/run/load_run.h"

namespace prehend::harness {

struct SuiteRequest {
  ScenarioSelection selection;
  RunRequest changes;  ///< its grammar and settings hold for every scenario
  std::string root;
  std::string report_folder;
  bool pictures = true;
  bool only_changed = false;  ///< skip what passed and depends on nothing that changed since
  int repeat = 1;
  std::optional<std::uint64_t> shuffle_seed;  ///< any order instead of the slowest first
  WorkerLimits limits;
};

/// Told after each run: how many of how many are done, and whose it was.
using SuiteProgress = std::function<void(std::size_t done, std::size_t all, const std::string& id)>;

/// One verdict per scenario in the order of the selection, then one per orphan.
std::vector<ScenarioVerdict> RunSuite(const SuiteRequest& request, const SuiteProgress& progress);

}  // namespace prehend::harness
