// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/resolve/classes_test.cc
#include <fmt/format.h>

#include <algorithm>

#include "harness/scenario/resolve/resolve.h"
#include "harness/scenario/scenario/scenario.h"
#include "physics/scene/geometry.h"
#include "physics/scene/run_limits.h"

namespace prehend::scenario {
namespace {

/// The declaration of this class and its base class; null if there is none.
const Named<Located<std::string>>* BaseOf(const ScenarioYaml& entry,
                                          const std::string& class_name) {
  const auto found =
      std::ranges::find(entry.classes, class_name, &Named<Located<std::string>>::name);
  return found == entry.classes.end() ? nullptr : &*found;
}

bool IsItsOwnBase(const ScenarioYaml& entry, const Named<Located<std::string>>& kind) {
  const Named<Located<std::string>>* next = &kind;
  for (std::size_t steps = 0; next && steps <= entry.classes.size(); ++steps) {
    if (next->value.value == kind.name) return true;
    next = BaseOf(entry, next->value.value);
  }
  return false;
}

/// Osmium has 22.6, gold 19.3, styrofoam 0.02, the lightest packing foam 0.006.
constexpr double kMaxDensity_kg_per_l = 25, kMinDensity_kg_per_l = 0.005;
constexpr double kMaxLoose_m = 5, kMaxFixed_m = 60, kMin_m = 0.004;

double Litres(const physics::Body& body) {
  double volume_m3 = 0;
  for (const physics::PlacedShape& part : body.shapes) volume_m3 += VolumeOf(part.shape);
  return 1000 * volume_m3;
}

void JudgeMass(const Named<EntityYaml>& entity, const physics::Body& body, DiagnosticList& odd) {
  const auto& mass_kg = entity.value.mass_kg;
  const double volume_l = Litres(body);
  if (!mass_kg || body.grains || volume_l <= 0) return;
  const double density = mass_kg->value / volume_l;
  if (density <= kMaxDensity_kg_per_l && density >= kMinDensity_kg_per_l) return;
  odd.Add(
      mass_kg->where,
      fmt::format("mass_kg: {:.6g} kg are {} for '{}', whose shape has {:.3g} litres: {:.3g} kg "
                  "per litre",
                  mass_kg->value, density > 1 ? "much" : "little", entity.name, volume_l, density),
      density > 1 ? "water has 1, lead 11; a mass is in kg, a size in metres"
                  : "air has 0.001, foam 0.02; a mass is in kg, a size in metres");
}

void JudgeSize(const Named<EntityYaml>& entity, const physics::Body& body, DiagnosticList& odd) {
  if (body.abstract != physics::Abstract::kNot || body.grains) return;
  const double largest_m = 2 * BoundingBox(body).half_size_m.maxCoeff();
  const double most_m = body.fixed ? kMaxFixed_m : kMaxLoose_m;
  if (largest_m <= most_m && largest_m >= kMin_m) return;
  odd.Add(entity.name_where,
          largest_m > most_m
              ? fmt::format("'{}' is {:.3g} m long{}", entity.name, largest_m,
                            body.fixed ? "" : ", and it is not fixed")
              : fmt::format("'{}' is {:.3g} mm large, and contacts are exact to 1 mm", entity.name,
                            1000 * largest_m),
          "sizes are in metres: 0.1 is 10 cm");
}

/// What stands on an entity, and on that, kilograms.
double LoadOn(const ScenarioYaml& entry, const std::string& name) {
  double load_kg = 0;
  for (const auto& other : entry.entities)
    if (other.value.on && other.value.on->value == name && other.value.mass_kg)
      load_kg += other.value.mass_kg->value + LoadOn(entry, other.name);
  return load_kg;
}

void JudgeLoad(const ScenarioYaml& entry, const Named<EntityYaml>& entity, DiagnosticList& odd) {
  const auto& mass_kg = entity.value.mass_kg;
  if (!mass_kg || mass_kg->value <= 0 || entity.value.fixed) return;
  const double ratio = LoadOn(entry, entity.name) / mass_kg->value;
  if (ratio <= physics::kMaxMassRatio) return;
  odd.Add(mass_kg->where,
          fmt::format("mass_kg: {:.0f} times as much as '{}' weighs stands on it, and from {:.0f} "
                      "times on it may sink in",
                      ratio, entity.name, physics::kMaxMassRatio),
          "make it heavier, or what stands on it lighter; or raise 'world: {rate_hz: ..}'");
}

}  // namespace

void ValidateClasses(const ScenarioYaml& entry, DiagnosticList& errors) {
  std::vector<std::string> used;  // classes that an entity or another class has
  for (const auto& entity : entry.entities) used.push_back(entity.value.class_name.value);
  for (const auto& kind : entry.classes) used.push_back(kind.value.value);
  for (const auto& kind : entry.classes) {
    for (const auto& [name, where] :
         {std::pair{kind.name, kind.name_where}, std::pair{kind.value.value, kind.value.where}}) {
      if (IsScenarioBuiltinClass(name))
        errors.Add(where, fmt::format("classes: '{}' is a built-in class", name),
                   "declare your own classes, for example 'Cup: Container'");
    }
    if (std::ranges::find(used, kind.name) == used.end())
      errors.AddUnknownName(kind.name_where,
                            fmt::format("classes: no entity has the class '{}'", kind.name),
                            kind.name, used);
    if (IsItsOwnBase(entry, kind))
      errors.Add(kind.value.where,
                 fmt::format("classes: '{}' is, directly or not, its own base class", kind.name));
  }
}

grammar::Diagnostics ImplausibleSizes(const ScenarioYaml& entry, const physics::Scene& scene,
                                      const YamlDocument& document) {
  DiagnosticList odd(document);
  for (std::size_t i = 0; i < entry.entities.size(); ++i) {
    JudgeMass(entry.entities[i], scene.bodies[i], odd);
    JudgeSize(entry.entities[i], scene.bodies[i], odd);
    JudgeLoad(entry, entry.entities[i], odd);
  }
  grammar::Diagnostics warnings = odd.Sorted();
  for (grammar::Diagnostic& warning : warnings) warning.is_warning = true;
  return warnings;
}

}  // namespace prehend::scenario
