// SPDX-License-Identifier: Apache-2.0
// The parts of the scenario format, one function per kind of entry. Each file NAME_fields.cc
// declares the keys of its part; scenario_fields.cc puts them together.
// Tested by tests/harness/scenario_fields_test.cc, abstract_entities_test.cc, vary_test.cc and
// outcome_test.cc
#pragma once

#include <vector>

#include "harness/complaints.h"
#include "harness/scenario_entries.h"
#include "harness/trials.h"
#include "harness/value_format.h"

namespace prehend::harness {

// entity_fields.cc: shape, material, and what it hangs on.
ValueFormat<EntityEntry> EntityFormat();

// shape_fields.cc
ValueFormat<physics::Box> BoxFormat();
ValueFormat<physics::Sphere> SphereFormat();
ValueFormat<physics::Cylinder> CylinderFormat();
ValueFormat<physics::Capsule> CapsuleFormat();
ValueFormat<physics::Tray> TrayFormat();
ValueFormat<physics::Mug> MugFormat();
ValueFormat<physics::Bowl> BowlFormat();
ValueFormat<physics::Shelf> ShelfFormat();
ValueFormat<physics::Hull> HullFormat();
ValueFormat<GrainsEntry> GrainsFormat();
ValueFormat<PartEntry> PartFormat();

// abstract_fields.cc: what has a place but no matter.
ValueFormat<RegionEntry> RegionFormat();
ValueFormat<GazeTargetEntry> GazeTargetFormat();
ValueFormat<CameraEntry> CameraFormat();
ValueFormat<LightEntry> LightFormat();

/// Complains about what only matter has: a mass, a surface, joints, something that it stands on.
void CheckAbstract(const YamlNode& node, const EntityEntry& entity, Complaints& complaints);

// actor_fields.cc
ValueFormat<ActorEntry> ActorFormat();
ValueFormat<physics::Eyes> EyesFormat();

// step_fields.cc: each step is told by its action key.
ValueFormat<StepEntry> StepFormat();

// trial_fields.cc
ValueFormat<VariationEntry> VariationFormat();
ValueFormat<std::vector<ConditionEntry>> OutcomeFormat();

}  // namespace prehend::harness
