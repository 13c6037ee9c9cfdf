// SPDX-License-Identifier: Apache-2.0
// Validates the classes that a scenario declares. Tested by
// tests/harness/scenario/resolve/classes_test.cc
#pragma once

#include "harness/base/yaml/diagnostic_list.h"
#include "harness/scenario/format/scenario_yaml.h"

namespace prehend::scenario {

/// Reports classes that are their own base class, and classes that no entity has.
void ValidateClasses(const ScenarioYaml& entry, DiagnosticList& errors);

}  // namespace prehend::scenario
