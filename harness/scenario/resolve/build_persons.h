// SPDX-License-Identifier: Apache-2.0
// From actors to persons: their parts become bodies, their hands are found by name.
// Tested by tests/harness/scenario/resolve/build_persons_test.cc
#pragma once

#include "harness/base/yaml/diagnostic_list.h"
#include "harness/scenario/format/scenario_yaml.h"
#include "physics/scene/scene.h"

namespace prehend::scenario {

/// Adds the persons and, after all other bodies, their parts to a scene that has its hands. Reports
/// hands that are unknown or belong to two arms, and parts whose names are taken.
void AddPersons(const ScenarioYaml& entry, physics::Scene& scene, DiagnosticList& errors);

}  // namespace prehend::scenario
