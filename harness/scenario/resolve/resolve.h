// SPDX-License-Identifier: Apache-2.0
// From the entries of a scenario to its scene and script, and what in them cannot be.
#pragma once

#include <string>
#include <vector>

#include "harness/base/yaml/diagnostic_list.h"
#include "harness/base/yaml/value_format.h"
#include "harness/scenario/format/scenario_formats.h"
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

// Finds what a scenario names. Tested by tests/harness/scenario/resolve/build_persons_test.cc

/// The index of the entity. Reports a name that none has, and that of an actor or of a part of one.
std::optional<std::size_t> FindEntity(const ScenarioYaml& entry, const Located<std::string>& name,
                                      std::string_view key, DiagnosticList& errors);

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

// From grasp styles as written to ordered frames of joint targets, and effort. Bodies of entities
// without matter: regions, gaze targets, cameras, lights. Tested by
// tests/harness/scenario/read/read_hand_model_test.cc and
// tests/harness/scenario/format/abstract_entities_test.cc

/// How a style with the name of an earlier one is treated.
enum class SameName { kIsRefused, kTakesItsPlace };

/// Appends the styles of a hand with these digits to `to`.
void AddStyles(const std::vector<Named<DigitYaml>>& digits,
               const std::vector<Named<StyleYaml>>& styles, SameName rule, DiagnosticList& errors,
               std::vector<physics::GraspStyle>& to);

/// Sets the body's shape and, for a camera, its orientation. `entity` is abstract; the body is at
/// its position.
void MakeAbstract(const EntityYaml& entity, physics::Body& body);

/// "a region" for a body without matter, "grains" for grains; "" for a thing.
std::string WhyNoThing(const physics::Body& body);

// The keys name, after and with of the script's steps. Tested by
// tests/harness/scenario/resolve/step_order_test.cc

/// What a step says about its turn.
const StepTimingYaml& TimingOf(const StepYaml& step);
physics::StepOrder OrderOf(const StepYaml& step);

/// What ends a step before its time, checked. `is_person`: the step is one of a person.
std::optional<physics::Until> UntilOf(const StepYaml& step, const physics::Scene& scene,
                                      bool is_person, DiagnosticList& errors);

/// Reports names that a stage has twice or not at all, and steps that wait for each other. `script`
/// is what was built of `stages`; `actors` are the names of all, `persons` those of persons.
void CheckStepOrder(const std::vector<StageYaml>& stages, const std::vector<std::string>& actors,
                    const std::vector<std::string>& persons, const physics::Script& script,
                    DiagnosticList& errors);

// From entries to the steps of persons.

/// Reports steps that are for hands, unknown entities to look at, and limbs that follow a hand.
physics::PersonStep MakePersonStep(const Named<StepYaml>& step, int person,
                                   const physics::Scene& scene, DiagnosticList& errors);

// How deep two shapes are in each other, to refuse scenes that would explode at the first tick. Not
// by libccd: on 60,000 random pairs, its EPA is three times slower (9 ms per pair if both shapes
// have the same centre), and decides 0.8 % of the overlapping pairs otherwise. Tested by
// tests/harness/scenario/resolve/penetration_test.cc

struct PlacedSolid {
  physics::Shape shape;
  physics::Pose X_WS;
};

/// Depth in metres; zero or negative if the shapes are apart. By separating axes (Gottschalk et al.
/// 1996) over the exact extents of the shapes: exact for boxes, spheres and hulls, never too small,
/// and too large for some poses of tilted cylinders and capsules.
double Penetration(const PlacedSolid& a, const PlacedSolid& b);

}  // namespace prehend::scenario
