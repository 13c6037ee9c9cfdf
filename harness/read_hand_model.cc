// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/read_hand_model_test.cc
#include "harness/read_hand_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numbers>

#include "harness/hand_fields.h"
#include "harness/record.h"

namespace prehend::harness {
namespace {

using physics::HandModel;

constexpr double kRadPerDeg = std::numbers::pi / 180;
constexpr const char* kEnding = ".hand.yaml";

/// Turns an entry into a model and complains about names and counts that do not fit together.
class HandBuilder {
 public:
  HandBuilder(const HandEntry& entry, Complaints& complaints)
      : entry_(entry), complaints_(complaints) {}

  HandModel Build() {
    HandModel model;
    model.name = entry_.name.value;
    model.ahead = entry_.ahead;
    model.friction = entry_.friction;
    model.spinning_friction = entry_.spinning_friction;
    model.sensor_sets = entry_.sensor_sets;
    model.palm_size_m = entry_.palm.size_m;
    model.palm_mass_kg = entry_.palm.mass_kg;
    model.palm_inertia_scale = entry_.palm.inertia_scale;
    model.palm_sensor_set = SensorSet(entry_.palm.sensor_set);
    model.translation = entry_.gains.translation;
    model.rotation = entry_.gains.rotation;
    model.driver = entry_.driver;
    for (const auto& digit : entry_.digits) AddDigit(digit, model.links);
    for (const auto& style : entry_.styles) model.styles.push_back(BuildStyle(style));
    return model;
  }

 private:
  int SensorSet(const Located<std::string>& name);
  void AddDigit(const Named<DigitEntry>& digit, std::vector<physics::HandLink>& links);
  physics::GraspStyle BuildStyle(const Named<StyleEntry>& style);
  std::vector<double> JointNumbers(const Located<PerDigit>& numbers, bool one_is_enough);
  /// False after complaining about a digit that the hand does not have.
  bool CheckDigitNames(const Located<PerDigit>& numbers);

  const HandEntry& entry_;
  Complaints& complaints_;
};

int HandBuilder::SensorSet(const Located<std::string>& name) {
  const auto& sets = entry_.sensor_sets;
  const auto it = std::find(sets.begin(), sets.end(), name.value);
  if (it != sets.end()) return static_cast<int>(it - sets.begin());
  complaints_.AddUnknownName(name.where,
                             fmt::format("sensor_set: '{}' is not in sensor_sets", name.value),
                             name.value, sets);
  return 0;
}

void HandBuilder::AddDigit(const Named<DigitEntry>& digit, std::vector<physics::HandLink>& links) {
  const int sensor_set = SensorSet(digit.value.sensor_set);
  Eigen::Vector3d pivot_m = digit.value.base_m;
  int parent = -1;
  for (const PhalanxEntry& phalanx : digit.value.phalanges) {
    links.push_back({.name = digit.name + "_" + phalanx.name,
                     .parent = parent,
                     .pivot_m = pivot_m,
                     .direction = digit.value.direction,
                     .joint_axis = phalanx.joint_axis,
                     .length_m = phalanx.length_m,
                     .half_width_m = phalanx.half_width_m,
                     .half_thickness_m = phalanx.half_thickness_m,
                     .mass_kg = phalanx.mass_kg,
                     .strength_nm = phalanx.strength_nm,
                     .lower_rad = phalanx.range_deg.value[0] * kRadPerDeg,
                     .upper_rad = phalanx.range_deg.value[1] * kRadPerDeg,
                     .sensor_set = sensor_set});
    parent = static_cast<int>(links.size()) - 1;
    pivot_m += digit.value.direction * phalanx.length_m;
  }
}

bool HandBuilder::CheckDigitNames(const Located<PerDigit>& numbers) {
  std::vector<std::string> names;
  for (const auto& digit : entry_.digits) names.push_back(digit.name);
  bool good = true;
  for (const auto& given : numbers.value) {
    if (std::find(names.begin(), names.end(), given.name) != names.end()) continue;
    good = false;
    complaints_.AddUnknownName(
        given.name_where, fmt::format("the hand has no digit '{}'", given.name), given.name, names);
  }
  return good;
}

/// One number per joint of the hand, in the order of its links.
std::vector<double> HandBuilder::JointNumbers(const Located<PerDigit>& numbers,
                                              bool one_is_enough) {
  const bool names_are_right = CheckDigitNames(numbers);
  std::vector<double> all;
  for (const auto& digit : entry_.digits) {
    const std::size_t joints = digit.value.phalanges.size();
    const auto given =
        std::find_if(numbers.value.begin(), numbers.value.end(),
                     [&](const auto& candidate) { return candidate.name == digit.name; });
    if (given == numbers.value.end()) {
      if (names_are_right)
        complaints_.Add(numbers.where, fmt::format("there is nothing for digit '{}'", digit.name));
      continue;
    }
    std::vector<double> values = given->value.value;
    if (values.size() == 1 && one_is_enough) values.resize(joints, values.front());
    if (values.size() != joints) {
      complaints_.Add(given->value.where,
                      fmt::format("{}: expected {} numbers, one for each joint, found {}",
                                  digit.name, joints, values.size()));
    }
    values.resize(joints);
    all.insert(all.end(), values.begin(), values.end());
  }
  return all;
}

physics::GraspStyle HandBuilder::BuildStyle(const Named<StyleEntry>& style) {
  physics::GraspStyle built{.name = style.name,
                            .effort = JointNumbers(style.value.effort, true),
                            .grip_axis = style.value.grip.axis,
                            .post_m = style.value.grip.post_m,
                            .opening_m = style.value.grip.opening_m,
                            .above = style.value.above,
                            .side = style.value.side};
  for (const auto& frame_deg : style.value.frames_deg) {
    std::vector<double> frame = JointNumbers(frame_deg, false);
    for (double& angle : frame) angle *= kRadPerDeg;
    built.frames_rad.push_back(std::move(frame));
  }
  return built;
}

void CheckName(const std::string& path, const Located<std::string>& name, Complaints& complaints) {
  const std::string file = std::filesystem::path(path).filename().string();
  if (file == name.value + kEnding) return;
  complaints.Add(
      name.where,
      fmt::format("hand: the name is '{}', but the file is called '{}'", name.value, file),
      "rename one of them");
}

ReadResult<HandModel> ReadMirror(const std::string& path, const YamlDocument& document) {
  Complaints complaints(document);
  MirrorEntry entry;
  if (!MirrorFormat().read(document.root, complaints, entry))
    return {std::nullopt, complaints.Sorted()};
  CheckName(path, entry.name, complaints);
  if (entry.mirror_of.value == entry.name.value)
    complaints.Add(entry.mirror_of.where, "a hand cannot mirror itself");
  if (!complaints.empty()) return {std::nullopt, complaints.Sorted()};

  const auto original_path =
      std::filesystem::path(path).parent_path() / (entry.mirror_of.value + kEnding);
  const ReadResult<YamlDocument> original_file = ReadYamlFile(original_path.string());
  if (original_file.value && original_file.value->root.Find("mirror_of")) {
    complaints.Add(entry.mirror_of.where,
                   fmt::format("'{}' is itself a mirror image", entry.mirror_of.value));
    return {std::nullopt, complaints.Sorted()};
  }
  ReadResult<HandModel> original = ReadHandModel(original_path.string());
  if (original.value) {
    original.value = physics::Mirrored(std::move(*original.value));
    original.value->name = entry.name.value;
  }
  return original;
}

}  // namespace

ReadResult<HandModel> ReadHandModel(const std::string& path) {
  ReadResult<YamlDocument> document = ReadYamlFile(path);
  if (!document.value) return {std::nullopt, std::move(document.diagnostics)};
  if (document.value->root.Find("mirror_of")) return ReadMirror(path, *document.value);

  Complaints complaints(*document.value);
  HandEntry entry;
  if (!HandFormat().read(document.value->root, complaints, entry))
    return {std::nullopt, complaints.Sorted()};
  CheckName(path, entry.name, complaints);
  HandModel model = HandBuilder(entry, complaints).Build();
  if (!complaints.empty()) return {std::nullopt, complaints.Sorted()};
  return {std::move(model), {}};
}

}  // namespace prehend::harness
