// SPDX-License-Identifier: Apache-2.0
// From the entries of a scenario to its scene and script, and what in them cannot be.
#pragma once

#include <vector>

#include "harness/base/yaml/diagnostic_list.h"
#include "harness/base/yaml/value_format.h"
#include "harness/scenario/format/scenario_yaml.h"
#include "harness/scenario/scenario/scenario.h"
#include "physics/motion/script.h"
#include "physics/scene/scene.h"

namespace prehend::scenario {

// From entities and actors to bodies and hands: shapes, poses, supports, hand models. Tested by
// tests/harness/scenario/read/read_scenario_test.cc

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

// From the written steps to physics::Script: names become indices, roll-pitch-yaw becomes
// quaternions. Tested by tests/harness/scenario/read/read_scenario_test.cc

/// Reports unknown actors, entities and styles, approaches that a style does not have, and a script
/// that is too long. `scene` has the hands and persons of `entry`, in that order; hands without
/// styles are not checked for theirs.
physics::Script BuildScript(const ScenarioYaml& entry, const physics::Scene& scene,
                            DiagnosticList& errors);

// From entities to joints and parts: what is attached to what, and what is part of what. Tested by
// tests/harness/scenario/resolve/build_joints_test.cc

/// The joints, in the order of their entities. Reports entities that are unknown, that are attached
/// to themselves, or that are fixed to something that cannot move.
std::vector<physics::Joint> BuildJoints(const ScenarioYaml& entry, DiagnosticList& errors);

/// For every entity the index of the one that it is part of, or grammar::kNoEntity: what is glued
/// to another entity is a part of it unless it says otherwise. Reports unknown names and entities
/// that are, directly or not, parts of themselves.
std::vector<int> PartsOf(const ScenarioYaml& entry, DiagnosticList& errors);

// From actors to persons: their parts become bodies, their hands are found by name.
// Tested by tests/harness/scenario/resolve/build_persons_test.cc

/// Adds the persons and, after all other bodies, their parts to a scene that has its hands. Reports
/// hands that are unknown or belong to two arms, and parts whose names are taken.
void AddPersons(const ScenarioYaml& entry, physics::Scene& scene, DiagnosticList& errors);

// From the written outcomes to conditions on bodies and joints: names become indices. Tested by
// tests/harness/episode/run/outcome_test.cc

/// Reports unknown entities, conditions on joints of entities without one, and times after the end.
std::vector<Outcome> BuildOutcomes(const std::vector<Named<std::vector<ConditionYaml>>>& entries,
                                   const physics::Scene& scene, const physics::Script& script,
                                   DiagnosticList& errors);

// Validates the classes that a scenario declares. Tested by
// tests/harness/scenario/resolve/classes_test.cc

/// Reports classes that are their own base class, and classes that no entity has.
void ValidateClasses(const ScenarioYaml& entry, DiagnosticList& errors);

// What a planar world cannot simulate: everything outside the plane y = 0, or that moves or rotates
// out of it. Tested by tests/harness/scenario/resolve/validate_planar_test.cc

/// Reports everything in the scenario that does not stay in the plane. The scene is the one that
/// was built of `entry`; bodies, hands and joints stand in the order of their entries.
void ValidatePlanar(const ScenarioYaml& entry, const physics::Scene& scene, DiagnosticList& errors);

// Follows the script on paper: where does each step leave the thing that a hand holds? What is put
// down beside its support, or where another thing stands, is an error before anything runs. Tested
// by tests/harness/scenario/resolve/validate_put_downs_test.cc

/// Reports each `place_on` with no part of the support below the thing, with the thing's centre
/// beside the support, or with another thing in the way by more than a centimetre. The scene is the
/// one that was built of `entry`. What the script does not say (where a thing is that was pushed,
/// dropped, led by way-points or moved on a joint) is not judged.
void ValidatePutDowns(const ScenarioYaml& entry, const physics::Scene& scene,
                      DiagnosticList& errors);

// Masses and sizes that are allowed but that nothing of the kind has: a unit was mistaken.
// Tested by tests/harness/scenario/resolve/plausible_sizes_test.cc

/// Warnings about things that are denser than any metal or lighter than any foam, larger than what
/// anybody moves, or smaller than what collisions tell apart. The scene is the one that was built
/// of `entry`, and `document` what it was read from.
grammar::Diagnostics ImplausibleSizes(const ScenarioYaml& entry, const physics::Scene& scene,
                                      const YamlDocument& document);

}  // namespace prehend::scenario
