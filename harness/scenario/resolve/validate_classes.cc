// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/resolve/classes_test.cc
#include <fmt/format.h>

#include <algorithm>

#include "harness/scenario/resolve/resolve.h"
#include "harness/scenario/scenario/scenario.h"

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

}  // namespace prehend::scenario
