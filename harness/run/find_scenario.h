// SPDX-License-Identifier: Apache-2.0
// Finds scenarios by name. Tested by tests/harness/run/find_scenario_test.cc
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace prehend::harness {

/// The folder of scenarios/ whose files are not scenarios, but show what the reader refuses.
inline constexpr std::string_view kShowsErrors = "invalid";

struct ScenarioFile {
  std::string skill;  ///< its folder below scenarios/, or ""
  std::string name;   ///< without ".yaml"
  std::string path;
  bool in_project = true;  ///< below root/scenarios, so that it has a golden
};

/// All below root/scenarios, sorted by skill and name, without the folder `invalid` (which shows
/// errors).
std::vector<ScenarioFile> ListScenarios(const std::string& root);

/// The file for what a user typed: a path, "name" or "skill/name". Nothing when there is none, or
/// when a bare name is that of several skills.
std::optional<std::string> FindScenario(const std::vector<ScenarioFile>& scenarios,
                                        const std::string& typed);

/// The one of `scenarios` that is the file at `path`; for another file one that is not of the
/// project.
ScenarioFile ScenarioAt(const std::vector<ScenarioFile>& scenarios, const std::string& path);

/// "skill/name", how goldens, reports and the command line call it; what is not of the project is
/// called by its path.
std::string IdOf(const ScenarioFile& file);

/// The scenario that was probably meant, when FindScenario() found nothing; or "".
std::string NearestScenario(const std::vector<ScenarioFile>& scenarios, const std::string& typed);

/// "did you mean 'milk_carton_wrap'?", or which skills share the name, or "". For when
/// FindScenario() found nothing.
std::string HintForScenario(const std::vector<ScenarioFile>& scenarios, const std::string& typed);

}  // namespace prehend::harness
