// SPDX-License-Identifier: Apache-2.0
// Validates the classes that a scenario declares. Tested by tests/harness/build/classes_test.cc
#pragma once

#include "harness/format/scenario_yaml.h"
#include "harness/yaml/diagnostic_list.h"

namespace prehend::harness {

/// Reports classes that are their own base class, and classes that no entity has.
void ValidateClasses(const ScenarioYaml& entry, DiagnosticList& errors);

}  // namespace prehend::harness
