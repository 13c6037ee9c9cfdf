// SPDX-License-Identifier: Apache-2.0
// Static checks of a golden: its events, roles, values and names exist in the scenario and its
// grammar. Whether they are recognised is up to `check`. Tested by
// tests/program/golden_workflow_test.cc
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/episode/run/find_scenario.h"
#include "harness/episode/run/load_run.h"

namespace prehend::suite {

/// The golden of the scenario `id`, loaded without changes.
grammar::Diagnostics ValidateGolden(const std::string& path, const std::string& id,
                                    const episode::LoadedRun& loaded);

/// A golden anywhere: below golden/ its place says of which scenario it is, elsewhere its header.
/// `inputs` gets every path that was read or looked for.
grammar::Diagnostics ValidateGoldenFile(const std::string& path, const std::string& root,
                                        std::vector<std::string>& inputs);

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
