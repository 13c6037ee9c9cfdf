// SPDX-License-Identifier: Apache-2.0
// Classes of entities and their base classes: the built-in ones, and those that a scenario
// declares. Tested by tests/harness/scenario/resolve/classes_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/scenario/scenario/scenario.h"

namespace prehend::scenario {

/// Whether every scenario has this class; a scenario may not declare one of the same name.
bool IsScenarioBuiltinClass(const std::string& name);

/// A class and its base classes, the most special first.
std::vector<std::string> WithBaseClasses(const std::string& class_name,
                                         const std::vector<BaseClass>& base_classes);

/// All classes of a body of the scenario, most special first: its own and their base classes, then
/// the built-in ones.
std::vector<std::string> ClassesOf(const Scenario& scenario, std::size_t body);

}  // namespace prehend::scenario
