// SPDX-License-Identifier: Apache-2.0
// The fields of entities that have a place but no matter: regions, gaze targets, cameras, lights.
// Tested by tests/harness/abstract_entities_test.cc
#pragma once

#include "harness/scenario_entries.h"

namespace prehend::harness {

Format<RegionEntry> RegionFormat();
Format<GazeTargetEntry> GazeTargetFormat();
Format<CameraEntry> CameraFormat();
Format<LightEntry> LightFormat();

/// Complains about what only matter has: a mass, a surface, joints, something that it stands on.
void CheckAbstract(const YamlNode& node, const EntityEntry& entity, Complaints& complaints);

/// The body's shape, and of a camera its pose. `entity` is abstract, the body at its place.
void MakeAbstract(const EntityEntry& entity, physics::Body& body);

/// "a region"; nothing for what is not abstract. Grains are "grains".
std::string WhyNoThing(const physics::Body& body);

}  // namespace prehend::harness
