// SPDX-License-Identifier: Apache-2.0
// Checks many scenarios, each in its own process, several at a time: slowest first, repeated on
// request, without those whose inputs have not changed. Tested by tests/program/runner_test.cc
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/base/process/worker_pool.h"
#include "harness/episode/episodes/plan.h"
#include "harness/episode/run/load_run.h"
#include "harness/suite/check/check_scenario.h"
#include "harness/suite/check/select_scenarios.h"
#include "harness/suite/check/verdict.h"

namespace prehend::suite {

struct SuiteRequest {
  ScenarioSelection selection;
  episode::GrammarChoice changes;  ///< holds for every scenario
  std::string recogniser = {};     ///< who is heard instead of the grammar: a command, or ""
  Listen listen = {};              ///< hears it
  std::string root;
  std::string report_folder;
  std::string record_file;  ///< an episode file that gets the first run of each; or empty
  episode::Plan plan = {};  ///< which that file pays; or without a UUID
  std::string today;        ///< YYYY-MM-DD, for that file
  bool pictures = true;
  bool all_pictures = true;  ///< also of what passed and is compared with no golden picture
  Replays replays = Replays::kNone;
  bool only_changed = false;  ///< skip what passed and depends on nothing that changed since
  int repeat = 1;
  std::optional<std::uint64_t> shuffle_seed;  ///< any order instead of the slowest first
  WorkerLimits limits;
};

/// Called after each run: how many of how many are done, and the id of the scenario.
using SuiteProgress = std::function<void(std::size_t done, std::size_t all, const std::string& id)>;

/// One verdict per scenario in the order of the selection, then one per orphan. When `interrupt`
/// comes, only those of the scenarios that have ended.
std::vector<ScenarioVerdict> RunSuite(const SuiteRequest& request, const SuiteProgress& progress,
                                      Interrupt* interrupt = nullptr);

}  // namespace prehend::suite
