// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/library_paths_test.cc
#include "harness/library_paths.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <tuple>

#include "harness/read_hand_model.h"

namespace prehend::harness {
namespace {

namespace fs = std::filesystem;

constexpr const char* kGrammarEnding = ".grammar";
constexpr const char* kHandEnding = ".hand.yaml";
constexpr const char* kScenarioEnding = ".yaml";

fs::path GrammarFolder(const fs::path& root) { return root / "grammar" / "library"; }
fs::path HandFolder(const fs::path& root) { return root / "physics" / "library"; }

std::optional<std::string> RootAbove(fs::path folder) {
  std::error_code error;
  for (;; folder = folder.parent_path()) {
    if (fs::is_directory(GrammarFolder(folder), error)) return folder.string();
    if (folder == folder.parent_path()) return std::nullopt;
  }
}

/// What the files in `folder` with this ending are called without it, sorted.
std::vector<std::string> NamesIn(const fs::path& folder, std::string_view ending) {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& file : fs::directory_iterator(folder, error)) {
    const std::string name = file.path().filename().string();
    if (name.ends_with(ending)) names.push_back(name.substr(0, name.size() - ending.size()));
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<const ScenarioFile*> Matching(const std::vector<ScenarioFile>& scenarios, const std::string& typed) {
  std::vector<const ScenarioFile*> matching;
  for (const ScenarioFile& scenario : scenarios) {
    if (typed == scenario.name || typed == scenario.skill + "/" + scenario.name) matching.push_back(&scenario);
  }
  return matching;
}

}  // namespace

std::optional<std::string> FindProjectRoot() {
  if (const char* home = std::getenv("PREHEND_HOME"); home && *home) return home;
  std::error_code error;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  if (auto root = RootAbove(executable.parent_path())) return root;
  return RootAbove(fs::current_path(error));
}

std::vector<ScenarioFile> ListScenarios(const std::string& root) {
  const fs::path folder = fs::path(root) / "scenarios";
  std::vector<ScenarioFile> scenarios;
  const auto add = [&](const fs::path& in, const std::string& skill) {
    for (const std::string& name : NamesIn(in, kScenarioEnding)) {
      scenarios.push_back({skill, name, (in / (name + kScenarioEnding)).string()});
    }
  };
  add(folder, "");
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string skill = entry.path().filename().string();
    if (entry.is_directory(error) && skill != "invalid") add(entry.path(), skill);
  }
  std::sort(scenarios.begin(), scenarios.end(), [](const ScenarioFile& a, const ScenarioFile& b) {
    return std::tie(a.skill, a.name) < std::tie(b.skill, b.name);
  });
  return scenarios;
}

std::optional<std::string> FindScenario(const std::vector<ScenarioFile>& scenarios, const std::string& typed) {
  const auto matching = Matching(scenarios, typed);
  if (matching.size() == 1) return matching.front()->path;
  std::error_code error;
  const bool is_path = typed.find('.') != std::string::npos || fs::exists(typed, error);
  if (matching.empty() && is_path) return typed;
  return std::nullopt;
}

std::string HintForScenario(const std::vector<ScenarioFile>& scenarios, const std::string& typed) {
  std::vector<std::string> names, in_skills;
  for (const ScenarioFile& scenario : scenarios) names.push_back(scenario.name);
  for (const ScenarioFile* scenario : Matching(scenarios, typed)) {
    in_skills.push_back(scenario->skill + "/" + scenario->name);
  }
  if (in_skills.size() > 1) return fmt::format("which one: {}?", fmt::join(in_skills, ", "));
  const std::string near = grammar::NearestName(typed.substr(typed.rfind('/') + 1), names);
  return near.empty() ? "" : fmt::format("did you mean '{}'?", near);
}

std::string GrammarPath(const std::string& root, const std::string& name) {
  return (GrammarFolder(root) / (name + kGrammarEnding)).string();
}

std::string HandPath(const std::string& root, const std::string& name) {
  return (HandFolder(root) / (name + kHandEnding)).string();
}

ScenarioLibrary ProjectLibrary(const std::string& root, std::vector<std::string>* files) {
  return {.grammars = NamesIn(GrammarFolder(root), kGrammarEnding),
          .hands = NamesIn(HandFolder(root), kHandEnding),
          .read_hand = [root, files](const std::string& name_or_path) {
            const bool is_path = name_or_path.ends_with(kScenarioEnding);
            const std::string path = is_path ? name_or_path : HandPath(root, name_or_path);
            if (files) files->push_back(path);
            return ReadHandModel(path);
          },
          .reads_recording = [files](const std::string& path) {
            if (files) files->push_back(path);
          }};
}

}  // namespace prehend::harness
