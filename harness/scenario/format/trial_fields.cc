// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/read/sample_variations_test.cc and
// tests/harness/episode/run/outcome_test.cc
#include <fmt/format.h>

#include <algorithm>

#include "harness/base/yaml/struct_format.h"
#include "harness/base/yaml/yaml_scalar.h"
#include "harness/scenario/format/limits.h"
#include "harness/scenario/format/scenario_fields.h"
#include "harness/scenario/format/scenario_formats.h"

namespace prehend::scenario {
namespace {

/// A text, or a number or flag as written: a value that a field can be set to.
ValueFormat<std::string> Value() {
  const ValueFormat<std::string> text = Text();
  return ValueFormat<std::string>(
      []() -> Json {
        return {{"type", {"string", "number", "boolean"}}};
      },
      [text](const YamlNode& node, DiagnosticList& errors, std::string& value) {
        const bool plain = node.kind == YamlNode::Kind::kScalar &&
                           (NumberOf(node) || node.text == "true" || node.text == "false");
        if (!plain) return text.Read(node, errors, value);
        value = node.text;
        return true;
      });
}

/// Reports conditions that can never hold, or always do.
void CheckCondition(const YamlNode& node, const ConditionYaml& wanted, DiagnosticList& errors) {
  const auto report = [&](const char* key, const std::string& message) {
    errors.Add(node.Find(key)->where, std::string(key) + ": " + message);
  };
  const auto nothing_between = [&](const char* above, const std::optional<double>& least,
                                   const char* below, const std::optional<double>& most) {
    if (least && most && *least >= *most)
      report(below, fmt::format("no value lies between '{}' and '{}'", above, below));
  };
  nothing_between("above_m", wanted.above_m, "below_m", wanted.below_m);
  nothing_between("tilt_above_deg", wanted.tilt_above_deg, "tilt_below_deg", wanted.tilt_below_deg);
  nothing_between("joint_above", wanted.joint_above, "joint_below", wanted.joint_below);
  if (node.Find("within_m") && !wanted.near_m) report("within_m", "there is no 'near_m'");
  if (node.Find("share") && !wanted.inside) report("share", "there is no 'inside'");
  const auto says_nothing = [](const YamlNode& field) {
    return field.key == "entity" || field.key == "at_s";
  };
  if (std::ranges::all_of(node.children, says_nothing))
    errors.Add(node.where, "this condition always holds",
               "add a requirement, for example above_m: 0.9");
}

ValueFormat<ConditionYaml> ConditionFormat() {
  using C = ConditionYaml;
  const auto height = Number(-kMaxDistance_m, kMaxDistance_m);
  const auto angle = Number(0, 180);
  const auto fraction = Number(0, 1);
  return StructFormat<C>("a condition")
      .Required("entity", &C::entity, Identifier(), "The entity that it is about.")
      .Optional("at_s", &C::at_s, Number(0, kMaxDuration_s), "When; default: when the run ends.")
      .Optional("near_m", &C::near_m, ListOf(height, 2, 3),
                "Its centre is near [x, y] or [x, y, z] ...")
      .Optional("within_m", &C::within_m, Number(0, kMaxDistance_m), "... as near as this.")
      .Optional("above_m", &C::above_m, height, "Its centre is higher than this.")
      .Optional("below_m", &C::below_m, height, "Its centre is lower than this.")
      .Optional("tilt_below_deg", &C::tilt_below_deg, angle,
                "It is tilted less than this since it was placed.")
      .Optional("tilt_above_deg", &C::tilt_above_deg, angle,
                "It is tilted more than this since it was placed.")
      .Optional("slower_than_m_per_s", &C::slower_than_m_per_s, Number(0, 100),
                "It moves slower than this.")
      .Optional("joint_above", &C::joint_above, fraction,
                "Its joint is above this fraction of its range.")
      .Optional("joint_below", &C::joint_below, fraction,
                "Its joint is below this fraction of its range.")
      .Optional("inside", &C::inside, Identifier(),
                "Its centre is in the bounding box of this entity.")
      .Optional("share", &C::share, fraction, "Of grains: at least this share of them is inside.")
      .Check(CheckCondition)
      .format();
}

}  // namespace

ValueFormat<VariationYaml> VariationFormat() {
  using V = VariationYaml;
  const auto range = Vector<2>(-kMaxNumber, kMaxNumber);
  return StructFormat<V>("a variation")
      .Required(
          "fields", &V::fields,
          ListOf(Word("[a-z0-9_]+(\\.[a-z0-9_]+)*", "a field like 'entities.milk.mass_kg'", 255), 1,
                 64),
          "The fields that get the same draw, written as for --set.")
      .Optional("uniform", &V::uniform, range, "Uniform in [min, max].")
      .Optional("normal", &V::normal, range, "Normal with [mean, standard deviation].")
      .Optional("plus", &V::plus, range, "The written value plus a uniform draw from [min, max].")
      .Optional("times", &V::times, range,
                "The written value times a uniform draw from [min, max].")
      .Optional("choose", &V::choose, ListOf(Value(), 1, 64), "One of these values.")
      .ExactlyOneOf({"uniform", "normal", "plus", "times", "choose"})
      .Check([](const YamlNode& node, const V& variation, DiagnosticList& errors) {
        for (const char* key : {"uniform", "plus", "times"}) {
          const YamlNode* written = node.Find(key);
          if (!written) continue;
          const auto& given = variation.uniform ? variation.uniform
                              : variation.plus  ? variation.plus
                                                : variation.times;
          if ((*given)[0] != (*given)[1]) CheckLeastMost(key, *given, written->where, errors);
        }
        if (variation.normal && (*variation.normal)[1] < 0)
          errors.Add(node.Find("normal")->where,
                     fmt::format("normal: expected [mean, deviation] with a deviation of at least "
                                 "0, found [{}, {}]",
                                 (*variation.normal)[0], (*variation.normal)[1]));
      })
      .format();
}

ValueFormat<std::vector<ConditionYaml>> OutcomeFormat() { return ListOf(ConditionFormat(), 1, 32); }

}  // namespace prehend::scenario
