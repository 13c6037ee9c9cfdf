// SPDX-License-Identifier: Apache-2.0
// Bodies of entities without matter: regions, gaze targets, cameras, lights. Tested by
// tests/harness/scenario/format/abstract_entities_test.cc
#pragma once

#include <string>

#include "harness/scenario/format/scenario_yaml.h"
#include "physics/scene/scene.h"

namespace prehend::scenario {

/// Sets the body's shape and, for a camera, its orientation. `entity` is abstract; the body is at
/// its position.
void MakeAbstract(const EntityYaml& entity, physics::Body& body);

/// "a region" for a body without matter, "grains" for grains; "" for a thing.
std::string WhyNoThing(const physics::Body& body);

}  // namespace prehend::scenario
