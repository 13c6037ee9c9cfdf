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

bool HasJaw(const DigitEntry& digit) { return digit.jaw.has_value(); }
bool HasPhalanges(const DigitEntry& digit) { return !HasJaw(digit); }
std::size_t JointsOf(const DigitEntry& digit) { return HasJaw(digit) ? 1 : digit.phalanges.size(); }

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
  using Concerned = bool (*)(const DigitEntry&);
  std::vector<std::vector<double>> JointNumbers(const Located<PerDigit>& numbers,
                                                bool one_is_enough, Concerned concerned);
  std::vector<std::vector<double>> FramesOf(const Named<StyleEntry>& style);
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

/// Everything but its name, its place and its joint's axis.
physics::HandLink LinkOf(const LinkEntry& link, double joint_unit, int sensor_set) {
  return {.length_m = link.length_m,
          .half_width_m = link.half_width_m,
          .half_thickness_m = link.half_thickness_m,
          .mass_kg = link.mass_kg,
          .strength = link.strength,
          .lower = link.range.value[0] * joint_unit,
          .upper = link.range.value[1] * joint_unit,
          .sensor_set = sensor_set};
}

void HandBuilder::AddDigit(const Named<DigitEntry>& digit, std::vector<physics::HandLink>& links) {
  const int sensor_set = SensorSet(digit.value.sensor_set);
  Eigen::Vector3d pivot_m = digit.value.base_m;
  int parent = -1;
  const auto add = [&](physics::HandLink link, const std::string& name,
                       const Eigen::Vector3d& joint_axis) {
    link.name = name;
    link.parent = parent;
    link.pivot_m = pivot_m;
    link.direction = digit.value.direction;
    link.joint_axis = joint_axis;
    links.push_back(std::move(link));
    parent = static_cast<int>(links.size()) - 1;
    pivot_m += digit.value.direction * links.back().length_m;
  };
  for (const PhalanxEntry& phalanx : digit.value.phalanges)
    add(LinkOf(phalanx, kRadPerDeg, sensor_set), digit.name + "_" + phalanx.name,
        phalanx.joint_axis);
  if (!digit.value.jaw) return;
  add(LinkOf(*digit.value.jaw, 1, sensor_set), digit.name, digit.value.jaw->slides);
  links.back().slides = true;
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

/// One number per joint of every concerned digit; the others stay empty.
std::vector<std::vector<double>> HandBuilder::JointNumbers(const Located<PerDigit>& numbers,
                                                           bool one_is_enough,
                                                           Concerned concerned) {
  const bool names_are_right = CheckDigitNames(numbers);
  std::vector<std::vector<double>> all(entry_.digits.size());
  for (std::size_t i = 0; i < entry_.digits.size(); ++i) {
    const auto& digit = entry_.digits[i];
    const auto given =
        std::find_if(numbers.value.begin(), numbers.value.end(),
                     [&](const auto& candidate) { return candidate.name == digit.name; });
    if (!concerned(digit.value)) {
      if (given != numbers.value.end())
        complaints_.Add(
            given->name_where,
            fmt::format("{}: phalanges belong into frames_deg, jaws into frames_m", digit.name));
      continue;
    }
    if (given == numbers.value.end()) {
      if (names_are_right)
        complaints_.Add(numbers.where, fmt::format("there is nothing for digit '{}'", digit.name));
      continue;
    }
    const std::size_t joints = JointsOf(digit.value);
    std::vector<double> values = given->value.value;
    if (values.size() == 1 && one_is_enough) values.resize(joints, values.front());
    if (values.size() != joints) {
      complaints_.Add(given->value.where,
                      fmt::format("{}: expected {} {}, one for each joint, found {}", digit.name,
                                  joints, joints == 1 ? "number" : "numbers", values.size()));
    }
    values.resize(joints);
    all[i] = std::move(values);
  }
  return all;
}

/// From open to closed, one number per link; empty after complaining.
std::vector<std::vector<double>> HandBuilder::FramesOf(const Named<StyleEntry>& style) {
  const auto& angles = style.value.frames_deg;
  const auto& ways = style.value.frames_m;
  const auto any = [&](Concerned of) {
    return std::any_of(entry_.digits.begin(), entry_.digits.end(),
                       [&](const auto& digit) { return of(digit.value); });
  };
  const auto missing = [&](const char* key) {
    complaints_.Add(style.name_where, fmt::format("style '{}' has no '{}'", style.name, key));
  };
  if (angles.empty() && any(HasPhalanges)) missing("frames_deg");
  if (ways.empty() && any(HasJaw)) missing("frames_m");
  if (!angles.empty() && !ways.empty() && angles.size() != ways.size()) {
    complaints_.Add(ways.front().where, fmt::format("frames_m: {} frames, but frames_deg has {}",
                                                    ways.size(), angles.size()));
    return {};
  }
  std::vector<std::vector<double>> frames(std::max(angles.size(), ways.size()));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    std::vector<std::vector<double>> turned(entry_.digits.size()), slid = turned;
    if (!angles.empty()) turned = JointNumbers(angles[i], false, HasPhalanges);
    if (!ways.empty()) slid = JointNumbers(ways[i], false, HasJaw);
    for (std::size_t k = 0; k < turned.size(); ++k) {
      for (const double angle : turned[k]) frames[i].push_back(angle * kRadPerDeg);
      frames[i].insert(frames[i].end(), slid[k].begin(), slid[k].end());
    }
  }
  return frames;
}

physics::GraspStyle HandBuilder::BuildStyle(const Named<StyleEntry>& style) {
  physics::GraspStyle built{.name = style.name,
                            .frames = FramesOf(style),
                            .grip_axis = style.value.grip.axis,
                            .post_m = style.value.grip.post_m,
                            .opening_m = style.value.grip.opening_m,
                            .above = style.value.above,
                            .side = style.value.side};
  const auto all = [](const DigitEntry&) { return true; };
  for (const auto& effort : JointNumbers(style.value.effort, true, all))
    built.effort.insert(built.effort.end(), effort.begin(), effort.end());
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
