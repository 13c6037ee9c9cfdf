// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/vary_test.cc and tests/harness/outcome_test.cc
#include "harness/trial_fields.h"

#include <fmt/format.h>

#include <algorithm>

#include "harness/build_script.h"
#include "harness/farthest.h"
#include "harness/record.h"
#include "harness/scenario_fields.h"
#include "harness/vary.h"

namespace prehend::harness {
namespace {

constexpr double kLargest = 1e6;

/// A text, or a number or flag as it is written: what a field can be set to.
Format<std::string> Value() {
  const Format<std::string> text = Text();
  return {.schema = {{"type", {"string", "number", "boolean"}}},
          .read =
              [text](const YamlNode& node, Complaints& complaints, std::string& value) {
                const bool plain = node.kind == YamlNode::Kind::kScalar &&
                                   (NumberOf(node) || node.text == "true" || node.text == "false");
                if (!plain) return text.read(node, complaints, value);
                value = node.text;
                return true;
              },
          .show = {}};
}

/// What can never hold, or always does.
void CheckCondition(const YamlNode& node, const ConditionEntry& wanted, Complaints& complaints) {
  const auto complain = [&](const char* key, const std::string& message) {
    complaints.Add(node.Find(key)->where, std::string(key) + ": " + message);
  };
  const auto nothing_between = [&](const char* above, const std::optional<double>& least,
                                   const char* below, const std::optional<double>& most) {
    if (least && most && *least >= *most)
      complain(below, fmt::format("nothing is between '{}' and '{}'", above, below));
  };
  nothing_between("above_m", wanted.above_m, "below_m", wanted.below_m);
  nothing_between("tilt_above_deg", wanted.tilt_above_deg, "tilt_below_deg", wanted.tilt_below_deg);
  nothing_between("joint_above", wanted.joint_above, "joint_below", wanted.joint_below);
  if (node.Find("within_m") && !wanted.near_m) complain("within_m", "there is no 'near_m'");
  if (node.Find("share") && !wanted.inside) complain("share", "there is no 'inside'");
  const auto says_nothing = [](const YamlNode& field) {
    return field.key == "entity" || field.key == "at_s";
  };
  if (std::ranges::all_of(node.children, says_nothing))
    complaints.Add(node.where, "a condition: it always holds", "say what, as above_m: 0.9");
}

Format<ConditionEntry> ConditionFormat() {
  using C = ConditionEntry;
  const auto height = Number(-kFarthestM, kFarthestM);
  const auto angle = Number(0, 180);
  const auto fraction = Number(0, 1);
  return Record<C>("a condition")
      .Required("entity", &C::entity, Identifier(), "The entity that it is about.")
      .Optional("at_s", &C::at_s, Number(0, kMaxDurationS), "When; default: when the run ends.")
      .Optional("near_m", &C::near_m, ListOf(height, 2, 3),
                "Its centre is near [x, y] or [x, y, z] ...")
      .Optional("within_m", &C::within_m, Number(0, kFarthestM), "... as near as this.")
      .Optional("above_m", &C::above_m, height, "Its centre is higher than this.")
      .Optional("below_m", &C::below_m, height, "Its centre is lower than this.")
      .Optional("tilt_below_deg", &C::tilt_below_deg, angle,
                "It is tilted less than this since it was placed.")
      .Optional("tilt_above_deg", &C::tilt_above_deg, angle,
                "It is tilted more than this since it was placed.")
      .Optional("slower_than_m_per_s", &C::slower_than_m_per_s, Number(0, 100),
                "It moves slower than this.")
      .Optional("joint_above", &C::joint_above, fraction,
                "Its joint stands above this fraction of its range.")
      .Optional("joint_below", &C::joint_below, fraction,
                "Its joint stands below this fraction of its range.")
      .Optional("inside", &C::inside, Identifier(),
                "Its centre is in the bounding box of this entity.")
      .Optional("share", &C::share, fraction, "Of grains: at least this share of them is inside.")
      .Check(CheckCondition)
      .format();
}

}  // namespace

Format<VariationEntry> VariationFormat() {
  using V = VariationEntry;
  const auto range = Vector<2>(-kLargest, kLargest);
  return Record<V>("a variation")
      .Required(
          "fields", &V::fields,
          ListOf(Word("[a-z0-9_]+(\\.[a-z0-9_]+)*", "a field like 'entities.milk.mass_kg'", 255), 1,
                 64),
          "The fields that get the same draw, written as for --set.")
      .Optional("uniform", &V::uniform, range, "Anything between [least, most].")
      .Optional("normal", &V::normal, range, "[mean, standard deviation].")
      .Optional("plus", &V::plus, range, "What is written, plus anything between [least, most].")
      .Optional("times", &V::times, range, "What is written, times anything between [least, most].")
      .Optional("choose", &V::choose, ListOf(Value(), 1, 64), "One of these values.")
      .ExactlyOneOf({"uniform", "normal", "plus", "times", "choose"})
      .Check([](const YamlNode& node, const V& variation, Complaints& complaints) {
        for (const char* key : {"uniform", "plus", "times"}) {
          const YamlNode* written = node.Find(key);
          if (!written) continue;
          const auto& given = variation.uniform ? variation.uniform
                              : variation.plus  ? variation.plus
                                                : variation.times;
          if ((*given)[0] != (*given)[1]) CheckLeastMost(key, *given, written->where, complaints);
        }
        if (variation.normal && (*variation.normal)[1] < 0)
          complaints.Add(
              node.Find("normal")->where,
              fmt::format("normal: expected [mean, deviation], and no deviation below 0, "
                          "found [{}, {}]",
                          (*variation.normal)[0], (*variation.normal)[1]));
      })
      .format();
}

Format<std::vector<ConditionEntry>> OutcomeFormat() { return ListOf(ConditionFormat(), 1, 32); }

namespace {

/// Names to bodies and joints, as far as the scene has them.
class ConditionBuilder {
 public:
  ConditionBuilder(const physics::Scene& scene, const physics::Script& script,
                   Complaints& complaints)
      : scene_(scene), complaints_(complaints), end_s_(DurationOf(script)) {
    // Every beat ends with a tick.
    latest_s_ = end_s_ + static_cast<double>(script.beats.size() + 1) / scene.world.rate_hz;
    for (const physics::Body& body : scene.bodies) names_.push_back(body.name);
  }

  std::optional<Outcome::Condition> Build(const ConditionEntry& wanted) const {
    Outcome::Condition condition{.wanted = wanted};
    condition.body = Find("entity", wanted.entity, wanted.where);
    if (condition.body < 0) return std::nullopt;
    condition.joint = JointOf(condition.body);
    if ((wanted.joint_above || wanted.joint_below) && condition.joint < 0)
      complaints_.Add(wanted.where, fmt::format("entity: '{}' hangs on no joint", wanted.entity));
    if (wanted.at_s && *wanted.at_s > latest_s_)
      complaints_.Add(
          wanted.where,
          fmt::format("at_s: {} s is after the end, which is at {:.3f} s", *wanted.at_s, end_s_),
          "without at_s it is looked at then");
    if (wanted.inside) {
      condition.vessel = Find("inside", wanted.inside->value, wanted.inside->where);
      if (condition.vessel == condition.body)
        complaints_.Add(wanted.inside->where, "inside: nothing is inside of itself");
    }
    return condition;
  }

 private:
  /// -1 after complaining.
  int Find(const char* key, const std::string& name, const Where& where) const {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found != names_.end()) return static_cast<int>(found - names_.begin());
    complaints_.AddUnknownName(where, fmt::format("{}: no entity is called '{}'", key, name), name,
                               names_);
    return -1;
  }

  int JointOf(int body) const {
    const auto joint =
        std::find_if(scene_.joints.begin(), scene_.joints.end(),
                     [&](const physics::Joint& candidate) { return candidate.body == body; });
    return joint == scene_.joints.end() ? -1 : static_cast<int>(joint - scene_.joints.begin());
  }

  const physics::Scene& scene_;
  Complaints& complaints_;
  double end_s_ = 0, latest_s_ = 0;
  std::vector<std::string> names_;
};

}  // namespace

std::vector<Outcome> BuildOutcomes(const std::vector<Named<std::vector<ConditionEntry>>>& entries,
                                   const physics::Scene& scene, const physics::Script& script,
                                   Complaints& complaints) {
  const ConditionBuilder builder(scene, script, complaints);
  std::vector<Outcome> outcomes;
  for (const auto& entry : entries) {
    if (entry.name == "failed" || entry.name == "other")
      complaints.Add(entry.name_where,
                     fmt::format("outcomes: '{}' is what trials are called that {}", entry.name,
                                 entry.name == "failed" ? "went wrong" : "have no other outcome"),
                     "choose another name");
    Outcome& outcome = outcomes.emplace_back();
    outcome.name = entry.name;
    for (const ConditionEntry& wanted : entry.value) {
      if (auto condition = builder.Build(wanted))
        outcome.conditions.push_back(std::move(*condition));
    }
  }
  return outcomes;
}

}  // namespace prehend::harness
