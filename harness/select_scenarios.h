// SPDX-License-Identifier: Apache-2.0
// Which scenarios a check is about. Tested by tests/house/command_line_test.cc
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/library_paths.h"

namespace prehend::harness {

struct ScenarioSelection {
  std::vector<ScenarioFile> scenarios;
  std::vector<std::string>
      orphans;  ///< goldens without scenario; looked for when nothing narrows the selection
};

/// `patterns` are globs over names and skill/name; none means all. `filter` is a glob, too, or
/// tag:NAME. When a pattern matches nothing, or nothing is left, `problem` says so.
std::optional<ScenarioSelection> SelectScenarios(const std::vector<std::string>& patterns,
                                                 const std::string& filter, const std::string& root,
                                                 std::string& problem);

}  // namespace prehend::harness
