// SPDX-License-Identifier: Apache-2.0
// Reads a scenario: YAML -> ScenarioYaml -> bodies, hands and script. Every error has its place in
// the file. Tested by tests/harness/scenario/read/read_scenario_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/base/base/result.h"
#include "harness/base/yaml/located_yaml.h"
#include "harness/scenario/read/scenario_library.h"
#include "harness/scenario/scenario/scenario.h"

namespace prehend::scenario {

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

}  // namespace prehend::scenario
