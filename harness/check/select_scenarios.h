// SPDX-License-Identifier: Apache-2.0
// Which scenarios a check is about. Tested by tests/program/command_line_test.cc
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/check/unreferenced_goldens.h"
#include "harness/run/find_scenario.h"

namespace prehend::harness {

struct ScenarioSelection {
  std::vector<ScenarioFile> scenarios;
  std::vector<Orphan> orphans;  ///< looked for when nothing narrows the selection
};

/// `patterns` are globs over names and skill/name, or files; none means all. A scenario must pass
/// each of `filters`, which are globs, too, or tag:NAME; with a leading '!' it must not match. When
/// a pattern matches nothing, or nothing is left, `problem` says so.
std::optional<ScenarioSelection> SelectScenarios(const std::vector<std::string>& patterns,
                                                 const std::vector<std::string>& filters,
                                                 const std::string& root, std::string& problem);

/// One of `count` parts of a selection; each scenario is in exactly one of them.
struct Shard {
  int number = 1;  ///< from 1 to count
  int count = 1;
};

/// "2/3"; nothing when it is no shard.
std::optional<Shard> ParseShard(std::string_view text);

/// Every count-th scenario. Orphans are of the first shard.
void KeepShard(const Shard& shard, ScenarioSelection& selection);

}  // namespace prehend::harness
