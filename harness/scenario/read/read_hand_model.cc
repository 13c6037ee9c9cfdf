// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/read/read_hand_model_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "harness/base/base/project_paths.h"
#include "harness/base/yaml/struct_format.h"
#include "harness/scenario/format/scenario_formats.h"
#include "harness/scenario/read/read_scenario.h"
#include "harness/scenario/resolve/resolve.h"

namespace prehend::scenario {
namespace {

namespace fs = std::filesystem;
using grammar::Diagnostics;
using physics::HandModel;

constexpr const char* kGraspsEnding = ".grasps.yaml";

/// Turns a parsed hand file into a model; reports names and counts that do not fit together.
class HandBuilder {
 public:
  HandBuilder(const HandYaml& entry, DiagnosticList& errors) : entry_(entry), errors_(errors) {}

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
    AddStyles(entry_.digits, entry_.styles, SameName::kIsRefused, errors_, model.styles);
    return model;
  }

 private:
  int SensorSet(const Located<std::string>& name);
  void AddDigit(const Named<DigitYaml>& digit, std::vector<physics::HandLink>& links);
  const HandYaml& entry_;
  DiagnosticList& errors_;
};

int HandBuilder::SensorSet(const Located<std::string>& name) {
  const auto& sets = entry_.sensor_sets;
  const auto it = std::find(sets.begin(), sets.end(), name.value);
  if (it != sets.end()) return static_cast<int>(it - sets.begin());
  errors_.AddUnknownName(name.where,
                         fmt::format("sensor_set: '{}' is not in sensor_sets", name.value),
                         name.value, sets);
  return 0;
}

void HandBuilder::AddDigit(const Named<DigitYaml>& digit, std::vector<physics::HandLink>& links) {
  const int sensor_set = SensorSet(digit.value.sensor_set);
  Eigen::Vector3d pivot_m = digit.value.base_m;
  physics::LinkIndex parent;
  const auto add = [&](const LinkYaml& written, const std::string& name, Where where,
                       double joint_unit) {
    if (std::ranges::count(links, name, &physics::HandLink::name) > 0)
      errors_.Add(where, fmt::format("two parts of the hand are called '{}'", name),
                  "a part has the name of its digit, a phalanx is called DIGIT_NAME");
    physics::HandLink& link = links.emplace_back(written);
    link.name = name;
    link.parent = parent;
    link.pivot_m = pivot_m;
    link.direction = digit.value.direction;
    link.lower = written.range.value[0] * joint_unit;
    link.upper = written.range.value[1] * joint_unit;
    link.sensor_set = sensor_set;
    parent = physics::LinkIndex(links.size() - 1);
    pivot_m += digit.value.direction * link.length_m;
  };
  for (const LinkYaml& phalanx : digit.value.phalanges)
    add(phalanx, digit.name + "_" + phalanx.called.value, phalanx.called.where,
        physics::kRadPerDeg);
  if (!digit.value.jaw) return;
  add(*digit.value.jaw, digit.name, digit.name_where, 1);
  links.back().slides = true;
}

/// `key` is the one whose value is the name.
void CheckName(const std::string& path, const char* ending, const char* key,
               const Located<std::string>& name, DiagnosticList& errors) {
  const std::string file = fs::path(path).filename().string();
  if (file == name.value + ending) return;
  errors.Add(
      name.where,
      fmt::format("{}: the name is '{}', but the file is called '{}'", key, name.value, file),
      "rename one of them");
}

/// The path of a file that a hand file names, in the same folder; nothing after an error.
std::optional<std::string> FindBeside(const std::string& path, const char* ending, const char* key,
                                      const Located<std::string>& name, DiagnosticList& errors) {
  const fs::path folder = fs::path(path).parent_path();
  const fs::path found = folder / (name.value + ending);
  std::error_code error;
  if (fs::exists(found, error)) return found.string();
  errors.AddUnknownName(name.where,
                        fmt::format("{}: there is no {}{} beside this file, in {}", key, name.value,
                                    ending, folder.empty() ? "." : folder.string()),
                        name.value, NamesIn(folder.empty() ? "." : folder, ending));
  return std::nullopt;
}

/// Reads the files of a hand and records their paths.
class HandReader {
 public:
  HandReader(const std::vector<std::string>& more_grasps, std::vector<std::string>* files)
      : more_grasps_(more_grasps), files_(files) {}

  Result<HandModel> Read(const std::string& path) {
    PREHEND_TRY(YamlDocument document, ReadFile(path));
    return document.root.Find("mirror_of") ? ReadMirror(path, document) : ReadHand(path, document);
  }

 private:
  Result<YamlDocument> ReadFile(const std::string& path) {
    if (files_) files_->push_back(path);
    return ReadYamlFile(path);
  }
  Result<HandModel> ReadHand(const std::string& path, const YamlDocument& document);
  Result<HandModel> ReadMirror(const std::string& path, const YamlDocument& document);
  Diagnostics AddGrasps(const std::string& path, const HandYaml& hand, SameName same_name,
                        HandModel& model);

  const std::vector<std::string>& more_grasps_;
  std::vector<std::string>* files_;
};

/// Appends the styles of a grasp file. Returns its errors.
Diagnostics HandReader::AddGrasps(const std::string& path, const HandYaml& hand, SameName same_name,
                                  HandModel& model) {
  PREHEND_TRY(YamlDocument document, ReadFile(path));
  DiagnosticList errors(document);
  GraspsYaml entry;
  if (GraspsFormat().Read(document.root, errors, entry)) {
    CheckName(path, kGraspsEnding, "grasps", entry.name, errors);
    AddStyles(hand.digits, entry.styles, same_name, errors, model.styles);
  }
  return errors.Sorted();
}

Result<HandModel> HandReader::ReadHand(const std::string& path, const YamlDocument& document) {
  DiagnosticList errors(document);
  HandYaml entry;
  if (!HandFormat().Read(document.root, errors, entry)) return tl::unexpected(errors.Sorted());
  CheckName(path, kHandEnding, "hand", entry.name, errors);
  HandModel model = HandBuilder(entry, errors).Build();
  Diagnostics in_grasps;
  const auto add = [&](const std::string& grasps, SameName same_name) {
    for (auto& diagnostic : AddGrasps(grasps, entry, same_name, model))
      in_grasps.push_back(std::move(diagnostic));
  };
  std::set<std::string> seen;
  for (const auto& name : entry.grasps) {
    if (!seen.insert(name.value).second) {
      errors.Add(name.where, fmt::format("grasps: '{}' is given twice", name.value));
    } else if (const auto grasps = FindBeside(path, kGraspsEnding, "grasps", name, errors)) {
      add(*grasps, SameName::kIsRefused);
    }
  }
  for (const std::string& grasps : more_grasps_) add(grasps, SameName::kTakesItsPlace);
  Diagnostics diagnostics = errors.Sorted();
  diagnostics.insert(diagnostics.end(), in_grasps.begin(), in_grasps.end());
  if (!diagnostics.empty()) return tl::unexpected(std::move(diagnostics));
  return model;
}

Result<HandModel> HandReader::ReadMirror(const std::string& path, const YamlDocument& document) {
  DiagnosticList errors(document);
  MirrorYaml entry;
  if (!MirrorFormat().Read(document.root, errors, entry)) return tl::unexpected(errors.Sorted());
  CheckName(path, kHandEnding, "hand", entry.name, errors);
  if (entry.mirror_of.value == entry.name.value)
    errors.Add(entry.mirror_of.where, "a hand cannot mirror itself");
  if (!errors.empty()) return tl::unexpected(errors.Sorted());

  const auto original_path = FindBeside(path, kHandEnding, "mirror_of", entry.mirror_of, errors);
  if (!original_path) return tl::unexpected(errors.Sorted());
  PREHEND_TRY(YamlDocument original_file, ReadFile(*original_path));
  if (original_file.root.Find("mirror_of")) {
    errors.Add(entry.mirror_of.where,
               fmt::format("'{}' is itself a mirror image", entry.mirror_of.value));
    return tl::unexpected(errors.Sorted());
  }
  Result<HandModel> original = ReadHand(*original_path, original_file);
  if (original) {
    *original = physics::Mirrored(std::move(*original));
    original->name = entry.name.value;
  }
  return original;
}

}  // namespace

Result<HandModel> ReadHandModel(const std::string& path,
                                const std::vector<std::string>& more_grasps,
                                std::vector<std::string>* files) {
  return HandReader(more_grasps, files).Read(path);
}

}  // namespace prehend::scenario
