// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/resolve/classes_test.cc
#include "harness/scenario/scenario/classes.h"

#include <algorithm>
#include <set>

namespace prehend::scenario {
namespace {

/// A body on a joint is neither fixed nor free to be picked up; only a slider or a hinge opens and
/// closes.
const char* MobilityOf(const physics::Scene& scene, physics::BodyIndex body) {
  if (scene.body(body).fixed) return "Fixed";
  const auto joint = std::ranges::find(scene.joints, body, &physics::Joint::body);
  if (joint == scene.joints.end()) return "Movable";
  const bool opens =
      joint->kind == physics::JointKind::kSlider || joint->kind == physics::JointKind::kHinge;
  return opens ? "Jointed" : "Attached";
}

std::vector<std::string> BuiltInClassesOf(const physics::Scene& scene, std::size_t body) {
  using physics::Abstract;
  const physics::Body& is = scene.bodies[body];
  switch (is.abstract) {
    case Abstract::kRegion:
      return {"Region", "Abstract", "Entity"};
    case Abstract::kGazeTarget:
      return {"GazeTarget", "Abstract", "Entity"};
    case Abstract::kCamera:
      return {"Camera", "Abstract", "Entity"};
    case Abstract::kLight:
      return {"Light", "Abstract", "Entity"};
    case Abstract::kNot:
      break;
  }
  if (is.grains) return {"Grains", "Entity"};
  const bool is_head = std::ranges::any_of(scene.persons, [&](const physics::Person& person) {
    return person.head == physics::BodyIndex(body);
  });
  if (is.kinematic && !is_head) return {"BodyPart", "Entity"};
  if (!physics::IsThing(is)) return {"Entity"};
  return {MobilityOf(scene, physics::BodyIndex(body)), "Thing", "Entity"};
}

}  // namespace

bool IsScenarioBuiltinClass(const std::string& name) {
  static const std::set<std::string> names = {
      "Entity",   "Thing",  "Movable",  "Fixed",  "Jointed",    "Attached", "Hand", "Person",
      "BodyPart", "Grains", "Abstract", "Region", "GazeTarget", "Camera",   "Light"};
  return names.contains(name);
}

std::vector<std::string> WithBaseClasses(const std::string& class_name,
                                         const std::vector<BaseClass>& base_classes) {
  std::vector<std::string> all = {class_name};
  while (all.size() <= base_classes.size()) {
    const auto found = std::ranges::find(base_classes, all.back(), &BaseClass::name);
    if (found == base_classes.end()) break;
    all.push_back(found->of);
  }
  return all;
}

std::vector<std::string> ClassesOf(const Scenario& scenario, std::size_t body) {
  std::vector<std::string> classes =
      WithBaseClasses(scenario.body_classes[body], scenario.base_classes);
  for (std::string& given : BuiltInClassesOf(scenario.scene, body))
    classes.push_back(std::move(given));
  return classes;
}

}  // namespace prehend::scenario
