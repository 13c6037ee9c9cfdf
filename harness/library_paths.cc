// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/library_paths_test.cc
#include "harness/library_paths.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <tuple>

#include "harness/read_hand_model.h"

namespace prehend::harness {
namespace {

namespace fs = std::filesystem;

constexpr const char* kGrammarEnding = ".grammar";
constexpr const char* kHandEnding = ".hand.yaml";
constexpr const char* kGraspsEnding = ".grasps.yaml";
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

/// The shortest of the names that contain a part; "" when none does, or when the part is of nearly
/// all names.
std::string ShortestWith(const std::string& part, const std::vector<std::string>& names) {
  constexpr std::size_t kShortestPart = 3;
  std::string shortest;
  if (part.size() < kShortestPart) return shortest;
  for (const std::string& name : names) {
    const bool is_shorter = shortest.empty() || name.size() < shortest.size();
    if (is_shorter && name.find(part) != std::string::npos) shortest = name;
  }
  return shortest;
}

std::vector<const ScenarioFile*> Matching(const std::vector<ScenarioFile>& scenarios,
                                          const std::string& typed) {
  std::vector<const ScenarioFile*> matching;
  for (const ScenarioFile& scenario : scenarios) {
    if (typed == scenario.name || typed == IdOf(scenario)) matching.push_back(&scenario);
  }
  return matching;
}

}  // namespace

std::optional<std::string> FindProjectRoot() {
  std::error_code error;
  if (const char* home = std::getenv("PREHEND_HOME"); home && *home) {
    return fs::is_directory(GrammarFolder(home), error) ? std::optional<std::string>(home)
                                                        : std::nullopt;
  }
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  if (auto root = RootAbove(executable.parent_path())) return root;
  return RootAbove(fs::current_path(error));
}

std::vector<ScenarioFile> ListScenarios(const std::string& root) {
  const fs::path folder = fs::path(root) / "scenarios";
  std::vector<ScenarioFile> scenarios;
  const auto add = [&](const fs::path& in, const std::string& skill) {
    for (const std::string& name : NamesIn(in, kScenarioEnding)) {
      const std::string file = name + kScenarioEnding;
      if (file.ends_with(kHandEnding) || file.ends_with(kGraspsEnding))
        continue;  // what scenarios use
      scenarios.push_back({skill, name, (in / file).string()});
    }
  };
  add(folder, "");
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string skill = entry.path().filename().string();
    if (entry.is_directory(error) && skill != kShowsErrors) add(entry.path(), skill);
  }
  std::sort(scenarios.begin(), scenarios.end(), [](const ScenarioFile& a, const ScenarioFile& b) {
    return std::tie(a.skill, a.name) < std::tie(b.skill, b.name);
  });
  return scenarios;
}

std::optional<std::string> FindScenario(const std::vector<ScenarioFile>& scenarios,
                                        const std::string& typed) {
  const auto matching = Matching(scenarios, typed);
  if (matching.size() == 1) return matching.front()->path;
  std::error_code error;
  const bool is_path = typed.find('.') != std::string::npos || fs::exists(typed, error);
  if (matching.empty() && is_path) return typed;
  return std::nullopt;
}

ScenarioFile ScenarioAt(const std::vector<ScenarioFile>& scenarios, const std::string& path) {
  const auto known = std::ranges::find(scenarios, path, &ScenarioFile::path);
  if (known != scenarios.end()) return *known;
  for (const ScenarioFile& scenario : scenarios) {
    std::error_code error;
    if (fs::equivalent(scenario.path, path, error)) return scenario;
  }
  return {.skill = "", .name = fs::path(path).stem().string(), .path = path, .in_project = false};
}

std::string IdOf(const ScenarioFile& file) {
  if (!file.in_project) return file.path;
  return file.skill.empty() ? file.name : file.skill + "/" + file.name;
}

std::string NearestScenario(const std::vector<ScenarioFile>& scenarios, const std::string& typed) {
  if (!Matching(scenarios, typed).empty()) return "";  // a name that several skills share
  std::vector<std::string> names;
  for (const ScenarioFile& scenario : scenarios) names.push_back(scenario.name);
  const std::string name = typed.substr(typed.rfind('/') + 1);
  const std::string near = grammar::NearestName(name, names);
  return near.empty() ? ShortestWith(name, names) : near;
}

std::string HintForScenario(const std::vector<ScenarioFile>& scenarios, const std::string& typed) {
  std::vector<std::string> in_skills;
  for (const ScenarioFile* scenario : Matching(scenarios, typed))
    in_skills.push_back(IdOf(*scenario));
  if (in_skills.size() > 1) return fmt::format("which one: {}?", fmt::join(in_skills, ", "));
  const std::string near = NearestScenario(scenarios, typed);
  return near.empty() ? "" : fmt::format("did you mean '{}'?", near);
}

std::vector<std::string> NamesIn(const std::string& folder, std::string_view ending) {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& file : fs::directory_iterator(folder, error)) {
    const std::string name = file.path().filename().string();
    if (name.ends_with(ending)) names.push_back(name.substr(0, name.size() - ending.size()));
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string GrammarPath(const std::string& root, const std::string& name) {
  return (GrammarFolder(root) / (name + kGrammarEnding)).string();
}

std::string HandPath(const std::string& root, const std::string& name) {
  return (HandFolder(root) / (name + kHandEnding)).string();
}

ScenarioLibrary ProjectLibrary(const std::string& root, std::vector<std::string>* files) {
  // Most scenarios have the same hand; its files are read once.
  struct Known {
    std::vector<std::string> files;
    ReadResult<physics::HandModel> hand;
  };
  const auto known = std::make_shared<std::map<std::string, Known>>();
  return {.grammars = NamesIn(GrammarFolder(root), kGrammarEnding),
          .hands = NamesIn(HandFolder(root), kHandEnding),
          .read_hand =
              [root, files, known](const std::string& name_or_path,
                                   const std::vector<std::string>& grasps) {
                const bool is_path = name_or_path.ends_with(kScenarioEnding);
                const std::string path = is_path ? name_or_path : HandPath(root, name_or_path);
                if (is_path || !grasps.empty()) return ReadHandModel(path, grasps, files);
                const auto [found, is_new] = known->try_emplace(path);
                Known& hand = found->second;
                if (is_new) hand.hand = ReadHandModel(path, {}, &hand.files);
                if (files) files->insert(files->end(), hand.files.begin(), hand.files.end());
                return hand.hand;
              },
          .reads_recording =
              [files](const std::string& path) {
                if (files) files->push_back(path);
              }};
}

}  // namespace prehend::harness
