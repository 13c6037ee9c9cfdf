// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/vary_test.cc
#include "harness/vary.h"

#include <fmt/format.h>

#include <cmath>

#include "harness/yaml_scalar.h"
#include "physics/random.h"

namespace prehend::harness {
namespace {

constexpr double kLargest = 1e6;

using physics::Random;

/// Every variation of every trial has a generator of its own: adding one leaves the others as they
/// were.
Random GeneratorFor(std::uint64_t seed, int trial, std::size_t variation) {
  Random mixed(seed);
  mixed = Random(mixed.Next() ^ static_cast<std::uint64_t>(trial));
  return Random(mixed.Next() ^ variation);
}

std::string DrawValue(const VariationEntry& variation, double written, Random& random) {
  if (variation.choose) return (*variation.choose)[random.Next() % variation.choose->size()];
  double value = written;
  if (variation.uniform) value = random.Between((*variation.uniform)[0], (*variation.uniform)[1]);
  if (variation.normal) value = random.Normal((*variation.normal)[0], (*variation.normal)[1]);
  if (variation.plus) value = written + random.Between((*variation.plus)[0], (*variation.plus)[1]);
  if (variation.times) value = written * random.Between((*variation.times)[0], (*variation.times)[1]);
  return fmt::format("{:.6f}", value);
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

std::optional<double> NumberOf(const YamlNode& node) {
  if (node.kind != YamlNode::Kind::kScalar) return std::nullopt;
  const auto number = MeaningOf(node).number;
  return number && std::abs(*number) <= kLargest ? number : std::nullopt;
}

std::vector<std::string> DrawTrial(const YamlDocument& document,
                                   const std::vector<VariationEntry>& variations,
                                   std::uint64_t seed, int trial) {
  std::vector<std::string> settings;
  for (std::size_t i = 0; i < variations.size(); ++i) {
    for (const std::string& field : variations[i].fields) {
      Random random = GeneratorFor(seed, trial, i);
      const YamlNode* node = FindField(document.root, field);
      const double written = node ? NumberOf(*node).value_or(0) : 0;
      settings.push_back(field + "=" + DrawValue(variations[i], written, random));
    }
  }
  return settings;
}

}  // namespace prehend::harness
