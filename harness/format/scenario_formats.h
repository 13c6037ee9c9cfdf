// SPDX-License-Identifier: Apache-2.0
// The parts of the scenario format, one function per kind of entry. Each file NAME_fields.cc
// declares the keys of its part; harness/format/scenario_fields.cc puts them together.
// Tested by tests/harness/format/scenario_fields_test.cc,
// tests/harness/format/abstract_entities_test.cc, tests/harness/read/sample_variations_test.cc and
// tests/harness/run/outcome_test.cc
#pragma once

#include <vector>

#include "harness/format/scenario_yaml.h"
#include "harness/scenario/variations.h"
#include "harness/yaml/diagnostic_list.h"
#include "harness/yaml/value_format.h"

namespace prehend::harness {

// harness/format/entity_fields.cc: shape, material, and what it hangs on.
Format<EntityYaml> EntityFormat();

// harness/format/shape_fields.cc
Format<physics::Box> BoxFormat();
Format<physics::Sphere> SphereFormat();
Format<physics::Cylinder> CylinderFormat();
Format<physics::Capsule> CapsuleFormat();
Format<physics::Tray> TrayFormat();
Format<physics::Mug> MugFormat();
Format<physics::Bowl> BowlFormat();
Format<physics::Shelf> ShelfFormat();
Format<physics::Hull> HullFormat();
Format<GrainsYaml> GrainsFormat();
Format<PartYaml> PartFormat();

// harness/format/abstract_fields.cc: what has a place but no matter.
Format<RegionYaml> RegionFormat();
Format<GazeTargetYaml> GazeTargetFormat();
Format<CameraYaml> CameraFormat();
Format<LightYaml> LightFormat();

/// Complains about what only matter has: a mass, a surface, joints, something that it stands on.
void CheckAbstract(const YamlNode& node, const EntityYaml& entity, DiagnosticList& errors);

// harness/format/actor_fields.cc
Format<ActorYaml> ActorFormat();
Format<physics::Eyes> EyesFormat();

// harness/format/step_fields.cc: each step is told by its action key.
Format<StepYaml> StepFormat();

// harness/format/trial_fields.cc
Format<VariationYaml> VariationFormat();
Format<std::vector<ConditionYaml>> OutcomeFormat();

}  // namespace prehend::harness
