// SPDX-License-Identifier: Apache-2.0
// The parts of the scenario format, one function per kind of entry. Each file NAME_fields.cc
// declares the keys of its part; harness/scenario/format/scenario_fields.cc puts them together.
// Limits on the size of a scenario, so that a typing error does not cost an hour. Tested by
// tests/harness/scenario/format/scenario_fields_test.cc,
// tests/harness/scenario/format/abstract_entities_test.cc,
// tests/harness/scenario/read/sample_variations_test.cc, tests/harness/episode/run/outcome_test.cc,
// tests/harness/scenario/read/read_scenario_test.cc and
// tests/harness/scenario/format/scenario_errors_test.cc
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "harness/base/yaml/diagnostic_list.h"
#include "harness/base/yaml/struct_format.h"
#include "harness/base/yaml/value_format.h"
#include "harness/scenario/format/scenario_yaml.h"
#include "harness/scenario/scenario/scenario.h"
#include "physics/motion/script.h"
#include "physics/scene/hand_model.h"
#include "physics/scene/run_limits.h"

namespace prehend::scenario {

// harness/scenario/format/entity_fields.cc: shape, material, joints.
ValueFormat<EntityYaml> EntityFormat();

// harness/scenario/format/shape_fields.cc
ValueFormat<physics::Box> BoxFormat();
ValueFormat<physics::Sphere> SphereFormat();
ValueFormat<physics::Cylinder> CylinderFormat();
ValueFormat<physics::Capsule> CapsuleFormat();
ValueFormat<physics::Tray> TrayFormat();
ValueFormat<physics::Mug> MugFormat();
ValueFormat<physics::Bowl> BowlFormat();
ValueFormat<physics::Shelf> ShelfFormat();
ValueFormat<physics::Hull> HullFormat();
ValueFormat<GrainsYaml> GrainsFormat();
ValueFormat<physics::PlacedShape> PartFormat();

// harness/scenario/format/shape_fields.cc: entities with a position but no mass.
ValueFormat<RegionYaml> RegionFormat();
ValueFormat<GazeTargetYaml> GazeTargetFormat();
ValueFormat<CameraYaml> CameraFormat();
ValueFormat<LightYaml> LightFormat();

/// Reports keys that apply only to physical bodies: mass, surface, joints, support.
void CheckAbstract(const YamlNode& node, const EntityYaml& entity, DiagnosticList& errors);

// harness/scenario/format/entity_fields.cc
ValueFormat<ActorYaml> ActorFormat();
ValueFormat<physics::Eyes> EyesFormat();

// harness/scenario/format/step_fields.cc: each step is recognised by its action key.
ValueFormat<StageYaml> StageFormat();

// harness/scenario/format/scenario_fields.cc
ValueFormat<VariationYaml> VariationFormat();
ValueFormat<std::vector<ConditionYaml>> OutcomeFormat();

// What people write first in a script, and what is written instead.

/// How steps are repeated.
inline constexpr const char* kRepeatRemedy =
    "steps are repeated by a block of their own: '- repeat: 3' and below it 'steps: [..]'";

/// Keys of steps that there are not.
Remedies StepRemedies();

// What ends a step before its time: "touching(milk)" or "gap(milk) < 5 mm", either with
// ", or go on". Tested by tests/harness/scenario/format/scenario_errors_test.cc

ValueFormat<physics::Until> UntilFormat();

/// How far from the origin a scenario may put or send anything.
inline constexpr double kMaxDistance_m = physics::kMaxDistance_m;

inline constexpr std::size_t kMaxEntities = 10'000;
inline constexpr std::size_t kMaxActors = 16;
inline constexpr std::size_t kMaxBeats = 1'000;
inline constexpr std::size_t kMaxStepsInARow = 200;  // of an actor in one stage
inline constexpr int kMaxRepeats = 100;
inline constexpr std::size_t kMaxPoses = 10'000;  ///< in all steps together
inline constexpr std::size_t kMaxPictures = 32;
inline constexpr std::size_t kMaxClaims = 64;
inline constexpr std::size_t kMaxClaimLength = 500;  ///< in bytes
inline constexpr double kMaxDuration_s = 1'800;
inline constexpr std::size_t kMaxVariations = 64;
inline constexpr std::size_t kMaxOutcomes = 16;

// A hand file as it is written: digits are straight chains of phalanges, or jaws that slide; angles
// are in degrees. Every key is declared once, in harness/scenario/format/hand_fields.cc;
// harness/scenario/read/read_scenario.h makes a physics::HandModel of it. Tested by
// tests/harness/scenario/read/read_hand_model_test.cc

struct PalmYaml {
  Eigen::Vector3d size_m = physics::HandModel{}.palm_size_m;
  double mass_kg = physics::HandModel{}.palm_mass_kg;
  double inertia_scale = physics::HandModel{}.palm_inertia_scale;
  Located<std::string> sensor_set;
};

/// A phalanx, or a jaw, which slides along a line, like a gripper's.
struct LinkYaml : physics::HandLink {
  Located<std::string> called;     ///< a phalanx, after its digit
  Located<Eigen::Vector2d> range;  ///< degrees of a phalanx, metres of a jaw
};

/// Has either phalanges or a jaw.
struct DigitYaml {
  Located<std::string> sensor_set;
  Eigen::Vector3d base_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
  std::vector<LinkYaml> phalanges;
  std::optional<LinkYaml> jaw;
};

/// Numbers for the joints of digits, by the digit's name.
using PerDigit = std::vector<Named<Located<std::vector<Located<double>>>>>;

struct GripYaml {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  Eigen::Vector3d post_m = Eigen::Vector3d::Zero();
  double opening_m = physics::GraspStyle{}.opening_m;
};

struct StyleYaml {
  GripYaml grip;
  std::optional<physics::GraspApproach> above, side;
  Located<PerDigit> effort;
  std::vector<Located<PerDigit>> frames_deg;  ///< of digits with phalanges
  std::vector<Located<PerDigit>> frames_m;    ///< of jaws
};

struct GainsYaml {
  physics::PidGains translation, rotation;
};

struct HandYaml {
  Located<std::string> name;
  std::vector<std::string> sensor_sets;
  Eigen::Vector3d ahead = Eigen::Vector3d::UnitX();
  double friction = physics::HandModel{}.friction;
  double spinning_friction = physics::HandModel{}.spinning_friction;
  PalmYaml palm;
  GainsYaml gains;
  physics::JointDriver driver;
  std::vector<Named<DigitYaml>> digits;
  std::vector<Located<std::string>> grasps;  ///< names of grasp files
  std::vector<Named<StyleYaml>> styles;
};

/// A grasp file: styles for hands that have these digits.
struct GraspsYaml {
  Located<std::string> name;
  std::vector<Named<StyleYaml>> styles;
};

/// The mirror image of another hand file.
struct MirrorYaml {
  Located<std::string> name;
  Located<std::string> mirror_of;
};

// Built once, since that takes longer than reading a hand.
const ValueFormat<HandYaml>& HandFormat();
const ValueFormat<MirrorYaml>& MirrorFormat();
const ValueFormat<GraspsYaml>& GraspsFormat();

}  // namespace prehend::scenario
