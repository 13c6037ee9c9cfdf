// SPDX-License-Identifier: Apache-2.0
// Files in golden/ that no scenario refers to: timelines and pictures of scenarios that do not
// exist, and pictures that their scenario does not ask for. Tested by
// tests/harness/truth/golden/golden_files_test.cc
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/episode/run/find_scenario.h"

namespace prehend::suite {

struct UnreferencedGolden {
  std::string scenario;  ///< skill/name of the one that does not exist
  std::vector<std::filesystem::path> files;
};

/// Sorted by scenario; `all` is every scenario of the project.
std::vector<UnreferencedGolden> FindUnreferencedGoldens(
    const std::vector<episode::ScenarioFile>& all, const std::string& root);

/// One line per file: "FILE belongs to no scenario: remove it, or bring scenarios/ID.yaml back".
std::string Text(const UnreferencedGolden& orphan);

/// The golden pictures of a scenario beyond the first `asked`.
std::vector<std::filesystem::path> UnrequestedPictures(const std::string& scenario,
                                                       std::size_t asked, const std::string& root);

/// "FILE belongs to no picture: the scenario asks for 1".
std::string UnrequestedText(const std::filesystem::path& picture, std::size_t asked);

}  // namespace prehend::suite
