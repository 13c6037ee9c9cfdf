// SPDX-License-Identifier: Apache-2.0
// Finds scenarios by name. Where an episode is, and what it came from. Tested by
// tests/harness/episode/run/find_scenario_test.cc and tests/program/episode_kinds_test.cc
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/scenario/read/read_scenario.h"

namespace prehend::episode {

enum class Origin {
  kScenario,     ///< to be simulated
  kRecordedRun,  ///< was simulated, and is kept in an episode file
  kRecording     ///< of a tracker or another program: frames as a grammar sees them, no physics
};

struct EpisodeName {
  std::string file;                    ///< a scenario, an episode file, or JSON Lines
  std::optional<std::int64_t> number;  ///< in an episode file
  std::string scenario;                ///< skill/name; of JSON Lines the name of the file
  Origin origin = Origin::kScenario;
  std::string grammar;     ///< that a recording names for itself, or a run was recorded with; or ""
  std::string asked = {};  ///< a grammar that a file of takes names instead of its own

  bool operator==(const EpisodeName&) const = default;
};

/// The folder of scenarios/ whose files are examples of errors.
inline constexpr std::string_view kShowsErrors = "invalid";
/// Below scenarios/, too: what `new` writes scenarios from.
inline constexpr std::string_view kTemplates = "templates";

struct ScenarioFile {
  std::string skill;  ///< its folder below scenarios/, as a ReadableName(), or ""
  std::string name;   ///< without ".yaml", likewise
  std::string path;
  bool in_project = true;  ///< below root/scenarios, so that it has a golden
  /// In the episode file at `path`: already played, or a recording.
  std::optional<std::int64_t> episode = {};
  Origin origin = Origin::kScenario;
  std::string asked = {};  ///< EpisodeName::asked
};

/// As an episode.
EpisodeName NameOf(const ScenarioFile& file);
/// An episode as the scenario that it is or was; only those of the project, `all`, have goldens.
ScenarioFile ScenarioOf(const EpisodeName& episode, const std::vector<ScenarioFile>& all);

/// A small letter, then small letters, digits and '_', at most 64 in all: what new ones may be
/// called, and their folders.
bool IsScenarioName(std::string_view word);

/// All below root/scenarios, sorted by skill and name, without the two folders above.
std::vector<ScenarioFile> ListScenarios(const std::string& root);

/// Files that look like scenarios and are not among these: with another ending (.yml, .YAML), a
/// folder deeper, in a folder scenario/. Paths from `root`, sorted.
std::vector<std::string> ScenariosNotRun(const std::string& root);

/// For a project of one's own the scenarios that ship with the program, which are found by name
/// when the project has none of this name. They are no part of the project.
std::vector<ScenarioFile> ShippedScenarios(const std::string& root);

/// The file for what a user typed: a path, "name" or "skill/name". No value if there is none, or if
/// several skills have a scenario of this name.
std::optional<std::string> FindScenario(const std::vector<ScenarioFile>& scenarios,
                                        const std::string& typed);

/// The one of `scenarios` that is the file at `path`; otherwise one that is not of the project.
ScenarioFile ScenarioAt(const std::vector<ScenarioFile>& scenarios, const std::string& path);

/// "skill/name", as in goldens, reports and on the command line; for a file outside of the project,
/// its path.
std::string IdOf(const ScenarioFile& file);

/// If FindScenario() found nothing: the scenario that was probably meant, or "".
std::string NearestScenario(const std::vector<ScenarioFile>& scenarios, const std::string& typed);

/// If FindScenario() found nothing: "did you mean 'milk_carton_wrap'?", or which skills share the
/// name, or "".
std::string HintForScenario(const std::vector<ScenarioFile>& scenarios, const std::string& typed);

// The grammars and hands that scenarios of a project can name.

/// Grammars and hands of the project. `files` receives the path of every hand that is read, and
/// must outlive the result.
scenario::ScenarioLibrary ProjectLibrary(const std::string& root,
                                         std::vector<std::string>* files = nullptr);

}  // namespace prehend::episode
