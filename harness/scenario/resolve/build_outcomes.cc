// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/episode/run/outcome_test.cc
#include <fmt/format.h>

#include <algorithm>

#include "harness/scenario/resolve/resolve.h"
#include "physics/motion/stage_clock.h"

namespace prehend::scenario {
namespace {

/// Resolves names to bodies and joints of the scene.
class ConditionBuilder {
 public:
  ConditionBuilder(const physics::Scene& scene, const physics::Script& script,
                   DiagnosticList& errors)
      : scene_(scene), errors_(errors), end_s_(physics::DurationOf(script)) {
    // Every stage ends with a tick.
    latest_s_ = end_s_ + static_cast<double>(script.stages.size() + 1) / scene.world.rate_hz;
    for (const physics::Body& body : scene.bodies) names_.push_back(body.name);
  }

  std::optional<Outcome::Condition> Build(const ConditionYaml& wanted) const {
    Outcome::Condition condition{.wanted = wanted};
    condition.body = Find("entity", {wanted.entity, wanted.where});
    if (condition.body == physics::kNone) return std::nullopt;
    condition.joint = JointOf(condition.body);
    if ((wanted.joint_above || wanted.joint_below) && condition.joint < 0)
      errors_.Add(wanted.where, fmt::format("entity: '{}' has no joint", wanted.entity));
    if (wanted.at_s && *wanted.at_s > latest_s_)
      errors_.Add(
          wanted.where,
          fmt::format("at_s: {} s is after the end of the run at {:.3f} s", *wanted.at_s, end_s_),
          "without at_s the condition is checked at the end");
    if (wanted.inside) {
      condition.vessel = Find("inside", *wanted.inside);
      if (condition.vessel == condition.body)
        errors_.Add(wanted.inside->where, "inside: an entity cannot be inside itself");
    }
    return condition;
  }

 private:
  /// None after an error.
  physics::BodyIndex Find(const char* key, const Located<std::string>& name) const {
    const auto found = errors_.Find(name, key, names_);
    return found ? physics::BodyIndex(*found) : physics::kNone;
  }

  int JointOf(physics::BodyIndex body) const {
    const auto joint =
        std::find_if(scene_.joints.begin(), scene_.joints.end(),
                     [&](const physics::Joint& candidate) { return candidate.body == body; });
    return joint == scene_.joints.end() ? -1 : static_cast<int>(joint - scene_.joints.begin());
  }

  const physics::Scene& scene_;
  DiagnosticList& errors_;
  double end_s_ = 0, latest_s_ = 0;
  std::vector<std::string> names_;
};

}  // namespace

std::vector<Outcome> BuildOutcomes(const std::vector<Named<std::vector<ConditionYaml>>>& entries,
                                   const physics::Scene& scene, const physics::Script& script,
                                   DiagnosticList& errors) {
  const ConditionBuilder builder(scene, script, errors);
  std::vector<Outcome> outcomes;
  for (const auto& entry : entries) {
    if (entry.name == "failed" || entry.name == "other")
      errors.Add(entry.name_where,
                 fmt::format("outcomes: '{}' is reserved for trials that {}", entry.name,
                             entry.name == "failed" ? "went wrong" : "match no outcome"),
                 "choose another name");
    Outcome& outcome = outcomes.emplace_back();
    outcome.name = entry.name;
    for (const ConditionYaml& wanted : entry.value) {
      if (auto condition = builder.Build(wanted))
        outcome.conditions.push_back(std::move(*condition));
    }
  }
  return outcomes;
}

}  // namespace prehend::scenario
