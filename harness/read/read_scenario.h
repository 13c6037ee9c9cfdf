// SPDX-License-Identifier: Apache-2.0
// Reads a scenario: YAML -> entries -> bodies, hands and script, with every complaint at its place.
// Tested by tests/harness/read/read_scenario_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/base/read_result.h"
#include "harness/read/scenario_library.h"
#include "harness/scenario/scenario.h"

namespace prehend::harness {

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
