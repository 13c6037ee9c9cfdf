// SPDX-License-Identifier: Apache-2.0
// Samples the variations of a trial. A trial is the scenario with some fields set as by --set, so
// every check of the file applies to it. Tested by
// tests/harness/scenario/read/sample_variations_test.cc
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "harness/base/yaml/diagnostic_list.h"
#include "harness/base/yaml/located_yaml.h"
#include "harness/scenario/scenario/scenario.h"

namespace prehend::scenario {

/// The settings ("entities.milk.mass_kg=0.31") of trial 1, 2, ...: the same for the same seed and
/// trial, independent of other trials. The variations have passed ValidateVariations().
std::vector<std::string> SampleTrial(const YamlDocument& document,
                                     const std::vector<VariationYaml>& variations,
                                     std::uint64_t seed, int trial);

/// The sample for all fields of a variation: a number, or one of the texts to choose from.
using Draw = std::variant<double, std::string>;

/// The bounds of a variation's samples: minimum and maximum, or all texts to choose from.
struct Bounds {
  const char* key = "";  ///< that of the distribution: "uniform"
  std::vector<Draw> draws;
};
Bounds BoundsOf(const VariationYaml& variation);

/// The setting, as for --set, that a sample gives to one of the variation's fields.
std::string SettingOf(const YamlDocument& document, const VariationYaml& variation,
                      const std::string& field, const Draw& draw);

/// The node at a path like "entities.milk.mass_kg"; null if there is none.
const YamlNode* FindField(const YamlNode& root, const std::string& path);

// Checks at load time that every value `vary:` can produce gives a valid scenario, so that no trial
// fails later. Tested by tests/harness/scenario/read/validate_variations_test.cc

/// Reports fields that do not exist, that are varied twice, or that are not numbers although
/// numbers are sampled.
void ValidateVariations(const YamlDocument& document, const std::vector<VariationYaml>& variations,
                        DiagnosticList& errors);

/// The errors of reading a scenario; empty if it is valid.
using Reader = std::function<grammar::Diagnostics(const YamlDocument&)>;

/// Applies each bound of each variation alone and reports the first that gives an invalid scenario.
/// Fields set on the command line are not varied and are skipped. ValidateVariations() found
/// nothing.
grammar::Diagnostics CheckDraws(const YamlDocument& document,
                                const std::vector<VariationYaml>& variations, const Reader& read);

}  // namespace prehend::scenario
