// SPDX-License-Identifier: Apache-2.0
// Reads a scenario: YAML -> entries -> bodies, hands and script, with every complaint at its place.
// Tested by tests/harness/read_scenario_test.cc
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/read_result.h"
#include "harness/scenario.h"

namespace prehend::harness {

/// What the names in a scenario may stand for. ProjectLibrary() in harness/library_paths.h makes
/// the usual one.
struct ScenarioLibrary {
  std::vector<std::string> grammars;
  std::vector<std::string> hands;
  /// The model for one of `hands`, or for the path of a .hand.yaml file, with the styles of these
  /// .grasps.yaml files.
  std::function<ReadResult<physics::HandModel>(const std::string& name_or_path,
                                               const std::vector<std::string>& grasps)>
      read_hand;
  /// Told of every recording before it is read; may be empty.
  std::function<void(const std::string& path)> reads_recording = {};
};

/// `overrides` are applied before anything is checked: "entities.milk.mass_kg=8". The scenario's
/// name must be that of the file, its skill is the folder between `scenarios/` and the file.
ReadResult<Scenario> ReadScenario(const std::string& path,
                                  const std::vector<std::string>& overrides,
                                  const ScenarioLibrary& library);

/// The same for a text that stands, or could stand, in `file`.
ReadResult<Scenario> ReadScenarioText(const std::string& file, std::string text,
                                      const std::vector<std::string>& overrides,
                                      const ScenarioLibrary& library);

}  // namespace prehend::harness
