// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/run/find_scenario.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <tuple>

#include "grammar/base/diagnostic.h"
#include "harness/base/base/number_text.h"
#include "harness/base/base/project_paths.h"
#include "harness/base/base/text_file.h"
#include "harness/scenario/read/read_scenario.h"

namespace prehend::episode {
namespace {

namespace fs = std::filesystem;

constexpr const char* kGraspsEnding = ".grasps.yaml";
constexpr const char* kScenarioEnding = ".yaml";

/// The shortest of the names that contain a part; "" when none does, or when the part is of nearly
/// all names.
std::string ShortestWith(const std::string& part, const std::vector<std::string>& names) {
  constexpr std::size_t kMinPartLength = 3;
  std::string shortest;
  if (part.size() < kMinPartLength) return shortest;
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

/// A YAML file, whatever the case of its ending, with a line `scenario: ..`.
bool LooksLikeScenario(const fs::path& file) {
  const std::string ending = EndingOf(file);
  std::error_code error;
  if ((ending != ".yaml" && ending != ".yml") || !fs::is_regular_file(file, error)) return false;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("scenario:")) return true;
  return false;
}

}  // namespace

scenario::ScenarioLibrary ProjectLibrary(const std::string& root, std::vector<std::string>* files) {
  // Most scenarios have the same hand; its files are read once.
  struct Known {
    std::vector<std::string> files;
    Result<physics::HandModel> hand;
  };
  const auto known = std::make_shared<std::map<std::string, Known>>();
  return {.grammars = GrammarNames(root),
          .hands = HandNames(root),
          .read_hand =
              [root, files, known](const std::string& name_or_path,
                                   const std::vector<std::string>& grasps) {
                const bool is_path = name_or_path.ends_with(".yaml");
                const std::string path =
                    is_path ? name_or_path : HandPath(root, name_or_path, files);
                if (is_path || !grasps.empty()) return scenario::ReadHandModel(path, grasps, files);
                const auto [found, is_new] = known->try_emplace(path);
                Known& hand = found->second;
                if (is_new) hand.hand = scenario::ReadHandModel(path, {}, &hand.files);
                if (files) files->insert(files->end(), hand.files.begin(), hand.files.end());
                return hand.hand;
              },
          .reads_recording =
              [files](const std::string& path) {
                if (files) files->push_back(path);
                return path;
              }};
}

bool IsScenarioName(std::string_view word) {
  return !word.empty() && word.size() <= 64 && word.front() >= 'a' && word.front() <= 'z' &&
         word.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == word.npos;
}

std::vector<ScenarioFile> ListScenarios(const std::string& root) {
  const fs::path folder = fs::path(root) / "scenarios";
  std::vector<ScenarioFile> scenarios;
  const auto add = [&](const fs::path& in, const std::string& skill) {
    for (const std::string& file : FilesIn(in.string(), kScenarioEnding)) {
      if (file.ends_with(kHandEnding) || file.ends_with(kGraspsEnding))
        continue;  // what scenarios use
      const std::string name = fs::path(file).stem().string();
      scenarios.push_back({skill, ReadableName(name), (in / file).string()});
    }
  };
  add(folder, "");
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string skill = entry.path().filename().string();
    if (entry.is_directory(error) && skill != kShowsErrors && skill != kTemplates)
      add(entry.path(), ReadableName(skill));
  }
  std::sort(scenarios.begin(), scenarios.end(), [](const ScenarioFile& a, const ScenarioFile& b) {
    return std::tie(a.skill, a.name) < std::tie(b.skill, b.name);
  });
  return scenarios;
}

std::vector<std::string> ScenariosNotRun(const std::string& root) {
  std::set<fs::path> run;
  for (const ScenarioFile& file : ListScenarios(root)) run.insert(fs::path(file.path));
  std::vector<std::string> strays;
  std::error_code error;
  for (const char* folder : {"scenarios", "scenario", "Scenarios"}) {
    for (fs::recursive_directory_iterator at(fs::path(root) / folder, error), end;
         !error && at != end; at.increment(error)) {
      const std::string name = at->path().filename().string();
      if (at.depth() == 0 && at->is_directory(error) &&
          (name == kShowsErrors || name == kTemplates))
        at.disable_recursion_pending();
      else if (!run.contains(at->path()) && LooksLikeScenario(at->path()))
        strays.push_back(at->path().lexically_relative(root).string());
    }
  }
  std::ranges::sort(strays);
  return strays;
}

std::vector<ScenarioFile> ShippedScenarios(const std::string& root) {
  if (!IsOwnProject(root) || ShippedRoot().empty()) return {};
  return ListScenarios(ShippedRoot());
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

EpisodeName NameOf(const ScenarioFile& file) {
  return {file.path, file.episode, IdOf(file), file.origin, "", file.asked};
}

ScenarioFile ScenarioOf(const EpisodeName& episode, const std::vector<ScenarioFile>& all) {
  ScenarioFile file =
      episode.number ? ScenarioFile{.path = episode.file} : ScenarioAt(all, episode.file);
  file.origin = episode.origin;
  file.asked = episode.asked;
  if (!episode.number) return file;
  const std::size_t slash = std::min(episode.scenario.rfind('/'), episode.scenario.size());
  const bool has_skill = slash < episode.scenario.size();
  file.skill = has_skill ? episode.scenario.substr(0, slash) : "";
  file.name = has_skill ? episode.scenario.substr(slash + 1) : episode.scenario;
  file.in_project = std::ranges::find(all, episode.scenario, IdOf) != all.end();
  file.episode = episode.number;
  return file;
}

}  // namespace prehend::episode
