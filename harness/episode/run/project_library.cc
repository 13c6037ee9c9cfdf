// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/episode/run/find_scenario_test.cc
#include "harness/episode/run/project_library.h"

#include <map>
#include <memory>

#include "harness/base/base/project_paths.h"
#include "harness/scenario/read/read_hand_model.h"

namespace prehend::episode {

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
                const std::string path = is_path ? name_or_path : HandPath(root, name_or_path);
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
              }};
}

}  // namespace prehend::episode
