// SPDX-License-Identifier: Apache-2.0
// From entries to bodies and hands: shapes, poses, what stands on what, which hand model.
// Tested by tests/harness/read/read_scenario_test.cc
#pragma once

#include "harness/format/scenario_yaml.h"
#include "harness/yaml/diagnostic_list.h"
#include "physics/scene/scene.h"

namespace prehend::harness {

/// The bodies, in the order of the entities. Complains about supports that are unknown or cyclic,
/// or that an entity's centre does not stand above; such an entity is placed at z = 0.
std::vector<physics::Body> PlaceBodies(const ScenarioYaml& entry, DiagnosticList& errors);

/// One hand of this model, as the actor says. Complains about gains that cannot be stable at the
/// rate.
physics::Hand PlaceHand(const Named<HandActorYaml>& actor, physics::HandModel model, int rate_hz,
                        DiagnosticList& errors);

/// Complains about things, persons and hands out of the world: a run would end in its first tick.
void ValidateDistances(const ScenarioYaml& entry, const physics::Scene& scene,
                       DiagnosticList& errors);

/// Complains about things that stand in each other by more than a millimetre: bodies, and hands
/// that start in one.
void ValidatePlacement(const ScenarioYaml& entry, const physics::Scene& scene,
                       DiagnosticList& errors);

}  // namespace prehend::harness
