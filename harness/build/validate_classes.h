// SPDX-License-Identifier: Apache-2.0
// Whether the classes that a scenario writes can be. Tested by tests/harness/build/classes_test.cc
#pragma once

#include "harness/format/scenario_yaml.h"
#include "harness/yaml/diagnostic_list.h"

namespace prehend::harness {

/// Complains about kinds of themselves, and about classes that nothing is of.
void ValidateClasses(const ScenarioYaml& entry, DiagnosticList& errors);

}  // namespace prehend::harness
