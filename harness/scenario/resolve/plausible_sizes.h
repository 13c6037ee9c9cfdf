// SPDX-License-Identifier: Apache-2.0
// Masses and sizes that are allowed but that nothing of the kind has: a unit was mistaken.
// Tested by tests/harness/scenario/resolve/plausible_sizes_test.cc
#pragma once

#include "harness/base/yaml/diagnostic_list.h"
#include "harness/scenario/format/scenario_yaml.h"
#include "physics/scene/scene.h"

namespace prehend::scenario {

/// Warnings about things that are denser than any metal or lighter than any foam, larger than what
/// anybody moves, or smaller than what collisions tell apart. The scene is the one that was built
/// of `entry`, and `document` what it was read from.
grammar::Diagnostics ImplausibleSizes(const ScenarioYaml& entry, const physics::Scene& scene,
                                      const YamlDocument& document);

}  // namespace prehend::scenario
