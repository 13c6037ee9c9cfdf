// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/kinds_test.cc
#include "harness/kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace prehend::harness {
namespace {

/// What hangs on a joint is neither fixed nor can it be picked up.
const char* MobilityOf(const physics::Scene& scene, int body) {
  if (scene.bodies[static_cast<std::size_t>(body)].fixed) return "Fixed";
  return physics::MovesFreely(scene, body) ? "Movable" : "Jointed";
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
  if (!physics::IsThing(is)) return {"Entity"};
  return {MobilityOf(scene, static_cast<int>(body)), "Thing", "Entity"};
}

/// The class that this one is a kind of; nullptr when that is not said.
const Named<Located<std::string>>* KindOf(const ScenarioEntry& entry,
                                          const std::string& class_name) {
  const auto found =
      std::ranges::find(entry.classes, class_name, &Named<Located<std::string>>::name);
  return found == entry.classes.end() ? nullptr : &*found;
}

bool IsKindOfItself(const ScenarioEntry& entry, const Named<Located<std::string>>& kind) {
  const Named<Located<std::string>>* next = &kind;
  for (std::size_t steps = 0; next && steps <= entry.classes.size(); ++steps) {
    if (next->value.value == kind.name) return true;
    next = KindOf(entry, next->value.value);
  }
  return false;
}

}  // namespace

bool IsBuiltInClass(const std::string& name) {
  static const std::set<std::string> names = {
      "Entity",   "Thing",  "Movable",  "Fixed",  "Jointed",    "Hand",   "Person",
      "BodyPart", "Grains", "Abstract", "Region", "GazeTarget", "Camera", "Light"};
  return names.contains(name);
}

void CheckKinds(const ScenarioEntry& entry, Complaints& complaints) {
  std::vector<std::string> used;  // classes that something is of
  for (const auto& entity : entry.entities) used.push_back(entity.value.class_name.value);
  for (const auto& kind : entry.classes) used.push_back(kind.value.value);
  for (const auto& kind : entry.classes) {
    for (const auto& [name, where] :
         {std::pair{kind.name, kind.name_where}, std::pair{kind.value.value, kind.value.where}}) {
      if (IsBuiltInClass(name))
        complaints.Add(where, fmt::format("classes: '{}' is built in and given anyway", name),
                       "kinds are classes of your own: 'Cup: Container'");
    }
    if (std::ranges::find(used, kind.name) == used.end())
      complaints.AddUnknownName(kind.name_where,
                                fmt::format("classes: no entity is of the class '{}'", kind.name),
                                kind.name, used);
    if (IsKindOfItself(entry, kind))
      complaints.Add(kind.value.where,
                     fmt::format("classes: '{}' is, directly or not, a kind of itself", kind.name));
  }
}

std::vector<std::string> WithKinds(const std::string& class_name,
                                   const std::vector<KindEntry>& kinds) {
  std::vector<std::string> all = {class_name};
  while (all.size() <= kinds.size()) {
    const auto found = std::ranges::find(kinds, all.back(), &KindEntry::name);
    if (found == kinds.end()) break;
    all.push_back(found->of);
  }
  return all;
}

std::vector<std::string> ClassesOf(const Scenario& scenario, std::size_t body) {
  std::vector<std::string> classes = WithKinds(scenario.body_classes[body], scenario.kinds);
  for (std::string& given : BuiltInClassesOf(scenario.scene, body))
    classes.push_back(std::move(given));
  return classes;
}

}  // namespace prehend::harness
