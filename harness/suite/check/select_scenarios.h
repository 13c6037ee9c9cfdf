// SPDX-License-Identifier: Apache-2.0
// Which scenarios a check plays. Tested by tests/harness/suite/check/select_scenarios_test.cc
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "harness/base/base/exit_code.h"
#include "harness/episode/run/find_scenario.h"
#include "harness/suite/judge/validate_golden.h"

namespace prehend::suite {

struct ScenarioSelection {
  std::vector<episode::ScenarioFile> scenarios;
  std::vector<UnreferencedGolden>
      orphans;  ///< only when neither patterns nor filters narrow the selection
};

/// Why nothing is selected; a file that is named and cannot be read is bad input.
struct NoSelection {
  ExitCode exit_code = ExitCode::kNothing;
  std::string why;
};

/// `patterns` are globs over names and skill/name, or files; none means all. A scenario must pass
/// each of `filters`, which are globs, too, or tag:NAME; with a leading '!' it must not match. If a
/// pattern matches no scenario, or none is left, nothing is selected.
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

}  // namespace prehend::suite
