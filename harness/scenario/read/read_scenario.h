// SPDX-License-Identifier: Apache-2.0
// Reads a scenario: YAML -> ScenarioYaml -> bodies, hands and script. Every error has its place in
// the file. Where a scenario's grammars, hands and recordings come from. Tested by
// tests/harness/scenario/read/read_scenario_test.cc
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/base/base/result.h"
#include "harness/base/yaml/located_yaml.h"
#include "harness/scenario/scenario/scenario.h"
#include "physics/scene/hand_model.h"

namespace prehend::scenario {

/// What the names in a scenario can refer to. ProjectLibrary() in
/// harness/episode/run/find_scenario.h makes the usual one.
struct ScenarioLibrary {
  std::vector<std::string> grammars;
  std::vector<std::string> hands;
  /// The model for one of `hands`, or for the path of a .hand.yaml file, with the styles of these
  /// .grasps.yaml files.
  std::function<Result<physics::HandModel>(const std::string& name_or_path,
                                           const std::vector<std::string>& grasps)>
      read_hand;
  /// Called with the path of each recording before it is read; says which one is. May be empty.
  std::function<std::string(const std::string& path)> reads_recording = {};
  /// The scenarios have been read and played before: what their `vary` may draw, and whether things
  /// stand within each other, is not checked again.
  bool were_played = false;
};

/// `overrides` are applied before anything is checked: "entities.milk.mass_kg=8". The scenario's
/// name must equal the file's; its skill is the folder between `scenarios/` and the file. On
/// failure the diagnostics are sorted by place.
Result<Scenario> ReadScenario(const std::string& path, const std::vector<std::string>& overrides,
                              const ScenarioLibrary& library);

/// The same of a document that was read before.
Result<Scenario> ReadScenario(const std::string& path, YamlDocument document,
                              const std::vector<std::string>& overrides,
                              const ScenarioLibrary& library);

/// The same for a text as if it were the content of `file`.
Result<Scenario> ReadScenarioText(const std::string& file, std::string text,
                                  const std::vector<std::string>& overrides,
                                  const ScenarioLibrary& library);

// Reads a hand, its strengths, gains and sensor sets from a .hand.yaml file, its grasp styles from
// there or from .grasps.yaml files. Tested by tests/harness/scenario/read/read_hand_model_test.cc

/// The styles of `more_grasps`, paths of grasp files, come after those of the hand; a style
/// replaces an earlier one of the same name. For a mirror image they are written for the original
/// hand. The paths of all files that were read are appended to `files`.
Result<physics::HandModel> ReadHandModel(const std::string& path,
                                         const std::vector<std::string>& more_grasps = {},
                                         std::vector<std::string>* files = nullptr);

}  // namespace prehend::scenario
