// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/resolve/build_joints_test.cc
#include <fmt/format.h>

#include <algorithm>

#include "harness/scenario/resolve/resolve.h"

namespace prehend::scenario {
namespace {

using physics::JointKind;

/// A relation of each entity to at most one other, without cycles.
class Relation {
 public:
  /// `to_itself` is the message about a cycle: "is part of itself".
  Relation(const ScenarioYaml& entry, std::string to_itself, DiagnosticList& errors)
      : to_itself_(std::move(to_itself)),
        errors_(errors),
        target_(entry.entities.size(), grammar::kNoEntity) {
    for (const auto& named : entry.entities) names_.push_back(named.name);
  }

  /// False after an error.
  bool Add(std::size_t i, const std::string& key, const Located<std::string>& name) {
    const auto found = errors_.Find(name, key, names_);
    if (!found) return false;
    target_[i] = static_cast<int>(*found);
    if (!LeadsBackTo(i)) return true;
    errors_.Add(name.where,
                fmt::format("{}: '{}', directly or not, {}", key, names_[i], to_itself_));
    target_[i] = grammar::kNoEntity;
    return false;
  }

  /// The same, where mistakes are reported elsewhere: they change nothing.
  void AddQuietly(std::size_t i, const std::string& name) {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end()) return;
    target_[i] = static_cast<int>(found - names_.begin());
    if (LeadsBackTo(i)) target_[i] = grammar::kNoEntity;
  }

  int target(std::size_t i) const { return target_[i]; }
  std::vector<int> targets() const { return target_; }

 private:
  bool LeadsBackTo(std::size_t i) const {
    int next = target_[i];
    while (next != grammar::kNoEntity && next != static_cast<int>(i))
      next = target_[static_cast<std::size_t>(next)];
    return next != grammar::kNoEntity;
  }

  const std::string to_itself_;
  DiagnosticList& errors_;
  std::vector<std::string> names_;
  std::vector<int> target_;
};

physics::Joint MakeJoint(const JointYaml& written) {
  physics::Joint joint = written;
  const double scale = written.kind == JointKind::kHinge ? physics::kRadPerDeg : 1;
  joint.axis_W.normalize();
  joint.lower = written.range.value[0] * scale;
  joint.upper = written.range.value[1] * scale;
  joint.rest *= scale;
  return joint;
}

}  // namespace

std::vector<physics::Joint> BuildJoints(const ScenarioYaml& entry, DiagnosticList& errors) {
  std::vector<physics::Joint> joints;
  Relation hangs_on(entry, "is attached to itself", errors);
  for (std::size_t i = 0; i < entry.entities.size(); ++i) {
    const EntityYaml& entity = entry.entities[i].value;
    if (!entity.joint) continue;
    const JointYaml& written = entity.joint->value;
    if (!hangs_on.Add(i, written.key, written.to)) continue;
    const auto base = static_cast<std::size_t>(hangs_on.target(i));
    if (written.kind == JointKind::kFixed && entry.entities[base].value.fixed) {
      errors.Add(written.to.where, fmt::format("fixed_to: '{}' never moves", written.to.value),
                 fmt::format("give '{}' 'fixed: true' instead", entry.entities[i].name));
    }
    if (AbstractOf(entry.entities[base].value) != physics::Abstract::kNot)
      errors.Add(written.to.where,
                 fmt::format("{}: '{}' is abstract: nothing can be attached to it", written.key,
                             written.to.value));
    if (entry.entities[base].value.grains)
      errors.Add(written.to.where,
                 fmt::format("{}: '{}' is grains: nothing can be attached to them", written.key,
                             written.to.value));
    physics::Joint& joint = joints.emplace_back(MakeJoint(written));
    joint.body = physics::BodyIndex(i);
    joint.base = physics::BodyIndex(base);
  }
  return joints;
}

std::vector<int> PartsOf(const ScenarioYaml& entry, DiagnosticList& errors) {
  Relation part_of(entry, "is part of itself", errors);
  for (std::size_t i = 0; i < entry.entities.size(); ++i) {
    const EntityYaml& entity = entry.entities[i].value;
    if (entity.part_of) part_of.Add(i, "part_of", *entity.part_of);
  }
  for (std::size_t i = 0; i < entry.entities.size(); ++i) {
    const EntityYaml& entity = entry.entities[i].value;
    const Located<std::string>* const whole = FixedTo(entity);
    if (!entity.part_of && whole) part_of.AddQuietly(i, whole->value);
  }
  return part_of.targets();
}

}  // namespace prehend::scenario
