// SPDX-License-Identifier: Apache-2.0
// From entities and actors to bodies and hands: shapes, poses, supports, hand models. Tested by
// tests/harness/scenario/read/read_scenario_test.cc
#pragma once

#include "harness/base/yaml/diagnostic_list.h"
#include "harness/scenario/format/scenario_yaml.h"
#include "physics/scene/scene.h"

namespace prehend::scenario {

/// The bodies, in the order of the entities. Reports supports that are unknown or cyclic, or that
/// are not below the entity's centre; such an entity is placed at z = 0.
std::vector<physics::Body> PlaceBodies(const ScenarioYaml& entry, DiagnosticList& errors);

/// A hand of this model with the actor's pose and gains. Reports gains that cannot be stable at the
/// rate.
physics::Hand PlaceHand(const Named<HandActorYaml>& actor, physics::HandModel model, int rate_hz,
                        DiagnosticList& errors);

/// Reports bodies, persons and hands too far from the origin: a run would end in its first tick.
void ValidateDistances(const ScenarioYaml& entry, const physics::Scene& scene,
                       DiagnosticList& errors);

/// Reports bodies that overlap by more than a millimetre, and hands that start inside a body.
void ValidatePlacement(const ScenarioYaml& entry, const physics::Scene& scene,
                       DiagnosticList& errors);

}  // namespace prehend::scenario
