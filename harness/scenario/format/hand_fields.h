// SPDX-License-Identifier: Apache-2.0
// A hand file as it is written: digits are straight chains of phalanges, or jaws that slide; angles
// are in degrees.
// Every key is declared once, in harness/scenario/format/hand_fields.cc;
// harness/scenario/read/read_scenario.h makes a physics::HandModel of it. Tested by
// tests/harness/scenario/read/read_hand_model_test.cc
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/base/yaml/value_format.h"
#include "physics/scene/hand_model.h"

namespace prehend::scenario {

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
