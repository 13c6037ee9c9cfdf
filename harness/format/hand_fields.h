// SPDX-License-Identifier: Apache-2.0
// A hand file as it is written: digits are straight chains of phalanges, or jaws that slide; angles
// are in degrees.
// Every key is declared once, in harness/format/hand_fields.cc; harness/read/read_hand_model.h
// makes a physics::HandModel of it. Tested by tests/harness/read/read_hand_model_test.cc
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/yaml/value_format.h"
#include "physics/scene/hand_model.h"

namespace prehend::harness {

struct PalmEntry {
  Eigen::Vector3d size_m = physics::HandModel{}.palm_size_m;
  double mass_kg = physics::HandModel{}.palm_mass_kg;
  double inertia_scale = physics::HandModel{}.palm_inertia_scale;
  Located<std::string> sensor_set;
};

/// What a phalanx and a jaw have in common.
struct LinkEntry {
  double length_m = 0, half_width_m = 0, half_thickness_m = 0;
  double mass_kg = 0;
  double strength = 0;             ///< newton metres of a phalanx, newtons of a jaw
  Located<Eigen::Vector2d> range;  ///< degrees of a phalanx, metres of a jaw
};

struct PhalanxEntry : LinkEntry {
  Located<std::string> name;
  Eigen::Vector3d joint_axis = Eigen::Vector3d::UnitY();
};

/// Slides straight, as those of a gripper do.
struct JawEntry : LinkEntry {
  Eigen::Vector3d slides = Eigen::Vector3d::UnitX();
};

/// Has either phalanges or a jaw.
struct DigitEntry {
  Located<std::string> sensor_set;
  Eigen::Vector3d base_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
  std::vector<PhalanxEntry> phalanges;
  std::optional<JawEntry> jaw;
};

/// Numbers for the joints of digits, by the digit's name.
using PerDigit = std::vector<Named<Located<std::vector<Located<double>>>>>;

struct GripEntry {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  Eigen::Vector3d post_m = Eigen::Vector3d::Zero();
  double opening_m = physics::GraspStyle{}.opening_m;
};

struct StyleEntry {
  GripEntry grip;
  std::optional<physics::GraspApproach> above, side;
  Located<PerDigit> effort;
  std::vector<Located<PerDigit>> frames_deg;  ///< of digits with phalanges
  std::vector<Located<PerDigit>> frames_m;    ///< of jaws
};

struct GainsEntry {
  physics::PidGains translation, rotation;
};

struct HandEntry {
  Located<std::string> name;
  std::vector<std::string> sensor_sets;
  Eigen::Vector3d ahead = Eigen::Vector3d::UnitX();
  double friction = physics::HandModel{}.friction;
  double spinning_friction = physics::HandModel{}.spinning_friction;
  PalmEntry palm;
  GainsEntry gains;
  physics::JointDriver driver;
  std::vector<Named<DigitEntry>> digits;
  std::vector<Located<std::string>> grasps;  ///< names of grasp files
  std::vector<Named<StyleEntry>> styles;
};

/// A grasp file: styles for hands that have these digits.
struct GraspsEntry {
  Located<std::string> name;
  std::vector<Named<StyleEntry>> styles;
};

/// The mirror image of another hand file.
struct MirrorEntry {
  Located<std::string> name;
  Located<std::string> mirror_of;
};

// Built once, since that takes longer than reading a hand.
const Format<HandEntry>& HandFormat();
const Format<MirrorEntry>& MirrorFormat();
const Format<GraspsEntry>& GraspsFormat();

}  // namespace prehend::harness
