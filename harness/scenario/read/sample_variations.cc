// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/read/sample_variations_test.cc
#include "harness/scenario/read/sample_variations.h"

#include <fmt/format.h>

#include <cmath>

#include "harness/base/yaml/yaml_scalar.h"
#include "harness/scenario/format/scenario_fields.h"
#include "physics/base/random.h"

namespace prehend::scenario {
namespace {

using physics::Random;

/// Each variation of each trial has its own generator, so adding a variation does not change the
/// samples of the others.
Random GeneratorFor(std::uint64_t seed, int trial, std::size_t variation) {
  Random mixed(seed);
  mixed = Random(mixed.Next() ^ static_cast<std::uint64_t>(trial));
  return Random(mixed.Next() ^ variation);
}

/// Normal samples are cut off here, so that they stay within the bounds that ValidateVariations()
/// has tried.
constexpr double kMaxDeviations = 3;

Draw SampleFrom(const VariationYaml& variation, Random& random) {
  if (variation.choose) return (*variation.choose)[random.Next() % variation.choose->size()];
  if (variation.normal) {
    double deviations = random.Normal(0, 1);
    while (std::abs(deviations) > kMaxDeviations) deviations = random.Normal(0, 1);
    return (*variation.normal)[0] + deviations * (*variation.normal)[1];
  }
  const auto& between = variation.uniform ? variation.uniform
                        : variation.plus  ? variation.plus
                                          : variation.times;
  return random.Between((*between)[0], (*between)[1]);
}

}  // namespace

const YamlNode* FindField(const YamlNode& root, const std::string& path) {
  const YamlNode* node = &root;
  for (std::size_t begin = 0; node && begin <= path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    node = ChildOf(*node, path.substr(begin, end - begin));
    begin = end + 1;
  }
  return node;
}

Bounds BoundsOf(const VariationYaml& variation) {
  if (variation.choose) return {"choose", {variation.choose->begin(), variation.choose->end()}};
  if (variation.normal) {
    const double mean = (*variation.normal)[0], most = kMaxDeviations * (*variation.normal)[1];
    return {"normal", {mean - most, mean + most}};
  }
  const auto from = [](const char* key, const Eigen::Vector2d& range) {
    return Bounds{key, {range[0], range[1]}};
  };
  if (variation.uniform) return from("uniform", *variation.uniform);
  return variation.plus ? from("plus", *variation.plus) : from("times", *variation.times);
}

std::string SettingOf(const YamlDocument& document, const VariationYaml& variation,
                      const std::string& field, const Draw& draw) {
  if (const auto* text = std::get_if<std::string>(&draw)) return field + "=" + *text;
  const YamlNode* node = FindField(document.root, field);
  const double written = node ? NumberOf(*node).value_or(0) : 0;
  double value = std::get<double>(draw);
  if (variation.plus) value = written + value;
  if (variation.times) value = written * value;
  if (IsWholeNumber(field, ScenarioFormat().schema().json(), document))
    return fmt::format("{}={}", field, std::llround(value));
  return fmt::format("{}={:.6f}", field, value);
}

std::vector<std::string> SampleTrial(const YamlDocument& document,
                                     const std::vector<VariationYaml>& variations,
                                     std::uint64_t seed, int trial) {
  std::vector<std::string> settings;
  for (std::size_t i = 0; i < variations.size(); ++i) {
    Random random = GeneratorFor(seed, trial, i);
    const Draw draw = SampleFrom(variations[i], random);
    for (const std::string& field : variations[i].fields)
      settings.push_back(SettingOf(document, variations[i], field, draw));
  }
  return settings;
}

}  // namespace prehend::scenario
