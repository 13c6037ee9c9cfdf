// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/read/sample_variations_test.cc
// Tested by tests/harness/scenario/read/validate_variations_test.cc
#include "harness/scenario/read/sample_variations.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "harness/base/yaml/yaml_scalar.h"
#include "harness/scenario/format/scenario_fields.h"
#include "physics/base/random.h"

namespace prehend::scenario {

namespace {

const YamlNode& NodeOf(const YamlDocument& document, std::size_t variation) {
  return document.root.Find("vary")->children[variation];
}

Where PlaceOfField(const YamlDocument& document, std::size_t variation, std::size_t field) {
  return NodeOf(document, variation).Find("fields")->children[field].where;
}

/// Two paths to one place ("at_m.0", "at_m.00") are the same field.
std::string CanonicalPath(const YamlNode& root, const std::string& path) {
  const YamlNode* node = FindField(root, path);
  return node ? fmt::format("{}:{}:{}", node->where.source, node->where.place.line,
                            node->where.place.column)
              : path;
}

bool IsSetOnCommandLine(const YamlDocument& document, const std::string& field) {
  const YamlNode* node = FindField(document.root, field);
  return node && node->where.source > 0;
}

/// Whether the error is in the path of the setting, not in its value or elsewhere.
bool IsAboutThePath(const grammar::Diagnostic& wrong, const std::string& setting) {
  return wrong.file == "--set" && wrong.place.column <= static_cast<int>(setting.find('=')) + 1;
}

/// A hint to quote the value makes no sense for a sampled number.
std::string HintFor(const grammar::Diagnostic& wrong, const VariationYaml& variation) {
  const bool wants_text = wrong.hint.starts_with("put it in quotes");
  return wants_text && !variation.choose ? "use choose: [...] for texts" : wrong.hint;
}

class DrawChecker {
 public:
  DrawChecker(const YamlDocument& document, const Reader& read)
      : document_(document), read_(read), errors_(document) {}

  void Check(const VariationYaml& variation, std::size_t index) {
    const Bounds bounds = BoundsOf(variation);
    const YamlNode& written = *NodeOf(document_, index).Find(bounds.key);
    for (std::size_t bound = 0; bound < bounds.draws.size(); ++bound) {
      YamlDocument varied = document_;
      std::string setting;
      for (const std::string& field : variation.fields) {
        if (IsSetOnCommandLine(document_, field)) continue;
        setting = SettingOf(document_, variation, field, bounds.draws[bound]);
        (void)ApplyOverride(setting, ScenarioFormat().schema().json(),
                            varied);  // ValidateVariations() has tried the path
      }
      if (setting.empty()) return;
      const grammar::Diagnostics wrong = read_(varied);
      if (wrong.empty()) continue;
      const Where where = IsAboutThePath(wrong.front(), setting) ? PlaceOfField(document_, index, 0)
                                                                 : written.children[bound].where;
      errors_.Add(where, fmt::format("with {}: {}", setting, wrong.front().message),
                  HintFor(wrong.front(), variation));
      return;
    }
  }

  grammar::Diagnostics Sorted() const { return errors_.Sorted(); }

 private:
  const YamlDocument& document_;
  const Reader& read_;
  DiagnosticList errors_;
};

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

void ValidateVariations(const YamlDocument& document, const std::vector<VariationYaml>& variations,
                        DiagnosticList& errors) {
  std::set<std::string> varied;
  YamlDocument tried = document;
  for (std::size_t i = 0; i < variations.size(); ++i) {
    const bool relative = variations[i].plus || variations[i].times;
    for (std::size_t k = 0; k < variations[i].fields.size(); ++k) {
      const std::string& field = variations[i].fields[k];
      const Where where = PlaceOfField(document, i, k);
      if (field == "vary" || field.starts_with("vary.")) {
        errors.Add(where, "fields: 'vary' itself cannot be varied");
        continue;
      }
      if (!varied.insert(CanonicalPath(document.root, field)).second)
        errors.Add(where, fmt::format("fields: '{}' is varied twice", field),
                   "give it one distribution");
      const YamlNode* node = FindField(document.root, field);
      const grammar::Diagnostics nowhere =
          ApplyOverride(field + "=0", ScenarioFormat().schema().json(), tried);
      if (!nowhere.empty() || (relative && !node)) {
        const std::string hint =
            nowhere.empty() ? "plus and times need a written number" : nowhere.front().hint;
        errors.Add(where, fmt::format("fields: the scenario has no '{}'", field), hint);
      } else if (relative && !NumberOf(*node)) {
        errors.Add(where, fmt::format("fields: '{}' is not a number", field));
      }
    }
  }
}

grammar::Diagnostics CheckDraws(const YamlDocument& document,
                                const std::vector<VariationYaml>& variations, const Reader& read) {
  DrawChecker checker(document, read);
  for (std::size_t i = 0; i < variations.size(); ++i) checker.Check(variations[i], i);
  return checker.Sorted();
}

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
