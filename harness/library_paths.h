// SPDX-License-Identifier: Apache-2.0
// Where things are: the project's root, the scenarios by name, the grammars and hands of the
// libraries. Tested by tests/harness/library_paths_test.cc
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/read_scenario.h"

namespace prehend::harness {

/// The folder that holds grammar/library, scenarios/, ...: $PREHEND_HOME if that is set, else the
/// nearest such ancestor of the executable, or of the working directory.
std::optional<std::string> FindProjectRoot();

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

/// What the files in `folder` with this ending are called without it, sorted.
std::vector<std::string> NamesIn(const std::string& folder, std::string_view ending);

/// root/grammar/library/NAME.grammar and root/physics/library/NAME.hand.yaml.
std::string GrammarPath(const std::string& root, const std::string& name);
std::string HandPath(const std::string& root, const std::string& name);

/// Grammars and hands of the project. `files` gets the path of every hand that is read, and must
/// live as long.
ScenarioLibrary ProjectLibrary(const std::string& root, std::vector<std::string>* files = nullptr);

}  // namespace prehend::harness
