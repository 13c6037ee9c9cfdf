// SPDX-License-Identifier: Apache-2.0
// The draws of a trial. A trial is the scenario with some fields changed, by --set as it were, so
// that every check of the file holds for it, too. Tested by
// tests/harness/read/sample_variations_test.cc
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "harness/scenario/variations.h"
#include "harness/yaml/located_yaml.h"

namespace prehend::harness {

/// The settings ("entities.milk.mass_kg=0.31") of trial 1, 2, ...: the same ones for the same seed
/// and trial, whatever was drawn before. The variations have passed ValidateVariations().
std::vector<std::string> SampleTrial(const YamlDocument& document,
                                     const std::vector<VariationYaml>& variations,
                                     std::uint64_t seed, int trial);

/// What is drawn for all fields of a variation: a number, or one of the texts to choose from.
using Draw = std::variant<double, std::string>;

/// What limits the draws of a variation: least and most, or all that can be chosen.
struct Bounds {
  const char* key = "";  ///< that of the distribution: "uniform"
  std::vector<Draw> draws;
};
Bounds BoundsOf(const VariationYaml& variation);

/// What a draw makes of one of the variation's fields, as for --set.
std::string SettingOf(const YamlDocument& document, const VariationYaml& variation,
                      const std::string& field, const Draw& draw);

/// What a path like "entities.milk.mass_kg" leads to; null when it leads nowhere.
const YamlNode* FindField(const YamlNode& root, const std::string& path);

}  // namespace prehend::harness
