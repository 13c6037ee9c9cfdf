// SPDX-License-Identifier: Apache-2.0
// Checks many scenarios, each in its own process, several at a time: slowest first, repeated on
// request, without those whose inputs have not changed. Tested by tests/program/runner_test.cc
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "harness/base/base/exit_code.h"
#include "harness/base/process/worker_pool.h"
#include "harness/episode/episodes/plan.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/episode/run/load_run.h"
#include "harness/suite/check/check_scenario.h"
#include "harness/suite/check/verdict.h"
#include "harness/suite/judge/validate_golden.h"

namespace prehend::suite {

// Which scenarios a check plays. Tested by tests/harness/suite/check/select_scenarios_test.cc

struct ScenarioSelection {
  std::vector<episode::ScenarioFile> scenarios;
  std::vector<UnreferencedGolden> orphans;  ///< whose scenarios would be selected, too
};

/// Why nothing is selected; a file that is named and cannot be read is bad input.
struct NoSelection {
  ExitCode exit_code = ExitCode::kNothing;
  std::string why;
};

/// `patterns` are globs over names and skill/name, or files, or names of what ships with the
/// program; none means all. A scenario must pass each of `filters`, which are globs, too, or
/// tag:NAME; with a leading '!' it must not match. If a pattern matches neither a scenario nor a
/// golden without one, or none is left, nothing is selected.
tl::expected<ScenarioSelection, NoSelection> SelectScenarios(
    const std::vector<std::string>& patterns, const std::vector<std::string>& filters,
    const std::string& root);

/// One of `count` parts of a selection; each scenario is in exactly one of them.
struct Shard {
  int number = 1;  ///< from 1 to count
  int count = 1;
  std::string costs = {};  ///< a file of LastPasses::Costs; "": each costs the same
};

/// Reads "2/3" and "2/3:costs.json"; nothing for any other text.
std::optional<Shard> ParseShard(std::string_view text);
/// What is wrong with it, or "".
std::string ShardProblem(const std::string& text);

/// The part, 1 to count, of each: in turn, or, where their costs are known, the most expensive
/// first and each to the part that has the least so far; one without a cost has the mean of the
/// others. The same on every machine. An error if the file of costs cannot be read. `note`: that
/// there are more parts than help, since one scenario alone costs more than the mean part.
Result<std::vector<int>> PartsOf(const Shard& shard, const std::vector<std::string>& names,
                                 std::string* note = nullptr);

/// Those whose part it is. Orphans are of the first shard.
void KeepShard(const Shard& shard, const std::vector<int>& parts, ScenarioSelection& selection);

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
