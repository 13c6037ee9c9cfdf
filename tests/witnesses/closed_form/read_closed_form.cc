// SPDX-License-Identifier: Apache-2.0
// Tested by tests/witnesses/closed_form/read_closed_form_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "harness/base/base/project_paths.h"
#include "harness/scenario/resolve/resolve.h"
#include "tests/witnesses/closed_form/closed_form.h"
#include "tests/witnesses/closed_form/closed_form_yaml.h"
#include "tests/witnesses/closed_form/kinematics.h"

namespace prehend::witnesses {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = ".yaml";
constexpr int kRate_hz = 480;

/// The usual ones, and one of 120 Hz that loses every fifth frame and two of every eleven.
std::vector<SamplingYaml> UsualSamplings() {
  std::vector<SamplingYaml> samplings;
  for (const int hz : {30, 60, 120, 240, 480}) samplings.push_back({.hz = hz});
  samplings.push_back(
      {.hz = 120, .lost = FormulaYaml{"mod(n, 5) == 3 || mod(n, 11) == 6 || mod(n, 11) == 7", {}}});
  return samplings;
}

/// From a file to formulas, with its errors.
class Reader {
 public:
  Reader(const std::string& path, const YamlDocument& document)
      : path_(path), document_(document), errors_(document) {}

  Result<ClosedForm> Read() {
    if (!ClosedFormFormat().Read(document_.root, errors_, entry_))
      return tl::unexpected(errors_.Sorted());
    ClosedForm form{.name = entry_.name.value, .file = path_, .shows = entry_.shows};
    if (fs::path(path_).stem() != form.name)
      errors_.Add(entry_.name.where,
                  fmt::format("closed_form: the name is '{}', but the file is called '{}'",
                              form.name, fs::path(path_).filename().string()),
                  "rename one of them");
    FormulaScope numbers;
    AddName(numbers, {"t_end", {}, {}}, entry_.lasts_s);
    for (const auto& number : entry_.numbers)
      AddName(numbers, number, Number(numbers, number.value));
    BuildScenario();
    ReadTruth(numbers, form.truth);
    WorldFormulas formulas = ReadFormulas(numbers);
    if (!errors_.empty()) return tl::unexpected(errors_.Sorted());
    const std::vector<SamplingYaml> samplings =
        entry_.sampled.empty() ? UsualSamplings() : entry_.sampled;
    Kinematics kinematics(scenario_.scene, std::move(formulas));
    for (const SamplingYaml& sampling : samplings)
      form.recordings.push_back(Play(kinematics, numbers, sampling));
    if (const auto& bad = kinematics.no_number())
      errors_.Add(bad->where, fmt::format("this is no number at t = {:.4f} s", bad->t_s));
    if (!errors_.empty()) return tl::unexpected(errors_.Sorted());
    return form;
  }

 private:
  void AddName(FormulaScope& scope, const Named<FormulaYaml>& named, double value) {
    if (IsNew(scope, named)) scope.AddConstant(named.name, value);
  }

  bool IsNew(const FormulaScope& scope, const Named<FormulaYaml>& named) {
    if (named.name != "t" && named.name != "n" && !scope.Knows(named.name)) return true;
    errors_.Add(named.name_where, fmt::format("'{}' has a meaning already", named.name),
                "choose another name");
    return false;
  }

  /// Reports what is wrong with it.
  std::optional<Formula> Compile(const FormulaScope& scope, const FormulaYaml& text) {
    auto formula = scope.Read(text.value);
    if (formula) return *formula;
    const FormulaError& error = formula.error();
    Where where = text.where;
    where.place.column += error.offset;
    if (error.unknown.empty())
      errors_.Add(where, error.message);
    else
      errors_.AddUnknownName(where, error.message, error.unknown, scope.names());
    return std::nullopt;
  }

  double Number(const FormulaScope& scope, const FormulaYaml& text) {
    const auto formula = Compile(scope, text);
    const double value = formula ? formula->Value() : 0;
    if (std::isfinite(value)) return value;
    errors_.Add(text.where, "this is no number");
    return 0;
  }

  LocatedFormula Compiled(const FormulaScope& scope, const FormulaYaml& text) {
    return {Compile(scope, text), text.where};
  }
  LocatedFormula Compiled(const FormulaScope& scope, const std::optional<FormulaYaml>& text) {
    return text ? Compiled(scope, *text) : LocatedFormula{};
  }
  LocatedVector Compiled(const FormulaScope& scope, const VectorFormula& texts) {
    LocatedVector compiled;
    for (std::size_t i = 0; i < texts.size(); ++i) compiled[i] = Compiled(scope, texts[i]);
    return compiled;
  }

  void BuildScenario() {
    scenario_.name = entry_.name.value;
    scenario_.file = path_;
    scenario_.shows = entry_.shows;
    scenario_.scene.world.rate_hz = kRate_hz;
    scenario::ScenarioYaml things;
    things.entities = entry_.entities;
    scenario_.scene.bodies = scenario::PlaceBodies(things, errors_);
    for (const auto& entity : entry_.entities) {
      scenario_.body_classes.push_back(entity.value.class_name.value);
      scenario_.body_part_of.push_back(grammar::kNoEntity);
    }
    for (const auto& hand : entry_.hands) {
      scenario_.scene.hands.push_back({.name = hand.name, .model = ModelOf(hand)});
      if (IndexOf(entry_.entities, hand.name) >= 0)
        errors_.Add(hand.name_where,
                    fmt::format("'{}' is already the name of an entity", hand.name));
    }
  }

  /// The sides are links that hang on the palm; the palm's sensor set is the last one.
  static physics::HandModel ModelOf(const Named<KinematicHandYaml>& hand) {
    physics::HandModel model;
    model.name = hand.name;
    model.ahead = hand.value.ahead.normalized();
    model.palm_size_m = hand.value.palm_m;
    model.translation.limit = 100;  // newtons: it can lift everything that these stories lift
    for (const auto& side : hand.value.sides) {
      physics::HandLink& link = model.links.emplace_back();
      link.name = side.name;
      link.length_m = side.value.size_m.x();
      link.half_width_m = side.value.size_m.y() / 2;
      link.half_thickness_m = side.value.size_m.z() / 2;
      link.sensor_set = static_cast<int>(model.sensor_sets.size());
      model.sensor_sets.push_back(side.name);
    }
    model.palm_sensor_set = static_cast<int>(model.sensor_sets.size());
    model.sensor_sets.emplace_back("palm");
    return model;
  }

  template <class T>
  static int IndexOf(const std::vector<Named<T>>& list, const std::string& name) {
    const auto found = std::ranges::find(list, name, &Named<T>::name);
    return found == list.end() ? -1 : static_cast<int>(found - list.begin());
  }

  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (const auto& entity : entry_.entities) names.push_back(entity.name);
    for (const auto& hand : entry_.hands) names.push_back(hand.name);
    return names;
  }

  void ReadTruth(const FormulaScope& numbers, std::vector<KnownEvent>& truth) {
    const std::vector<std::string> names = Names();
    for (const KnownEventYaml& event : entry_.truth) {
      const std::string& label = event.label.value;
      const std::size_t open = label.find('('), comma = label.find(", ");
      for (const std::string& role : {label.substr(open + 1, comma - open - 1),
                                      label.substr(comma + 2, label.size() - comma - 3)}) {
        if (std::ranges::find(names, role) == names.end())
          errors_.AddUnknownName(event.label.where, fmt::format("unknown name '{}'", role), role,
                                 names);
      }
      truth.push_back({label, Number(numbers, event.begin), Number(numbers, event.end)});
      if (truth.back().begin_s < truth.back().end_s && truth.back().begin_s >= 0 &&
          truth.back().end_s <= entry_.lasts_s)
        continue;
      errors_.Add(event.begin.where,
                  fmt::format("expected begin and end within 0 and {} s, found {:.4f} and {:.4f}",
                              entry_.lasts_s, truth.back().begin_s, truth.back().end_s));
    }
  }

  WorldFormulas ReadFormulas(const FormulaScope& numbers) {
    WorldFormulas formulas{.scope = numbers};
    FormulaScope& scope = formulas.scope;
    formulas.t_s = &scope.AddVariable("t");
    for (const auto& curve : entry_.curves) {
      if (!IsNew(scope, curve)) continue;
      LocatedFormula formula = Compiled(scope, curve.value);
      formulas.curves.push_back({&scope.AddVariable(curve.name), std::move(formula)});
    }
    formulas.bodies.resize(scenario_.scene.bodies.size());
    for (const auto& motion : entry_.motions) {
      const int body = IndexOf(entry_.entities, motion.name);
      if (body < 0) {
        errors_.AddUnknownName(motion.name_where,
                               fmt::format("no entity is called '{}'", motion.name), motion.name,
                               Names());
        continue;
      }
      formulas.bodies[static_cast<std::size_t>(body)] = {Compiled(scope, motion.value.by_m),
                                                         Compiled(scope, motion.value.rpy_deg)};
    }
    for (const auto& hand : entry_.hands) {
      formulas.hands.push_back({Compiled(scope, hand.value.at_m),
                                Compiled(scope, hand.value.rpy_deg),
                                Compiled(scope, hand.value.trigger),
                                {}});
      for (const auto& side : hand.value.sides)
        formulas.hands.back().sides_m.push_back(Compiled(scope, side.value.at_m));
    }
    for (const TouchYaml& touch : entry_.contacts)
      formulas.touches.push_back({SideOf(touch.between[0]), SideOf(touch.between[1]),
                                  Compiled(scope, touch.during), Compiled(scope, touch.force_n),
                                  Compiled(scope, touch.normal), Compiled(scope, touch.at_m)});
    return formulas;
  }

  /// "cup", or "hand.thumb".
  physics::ContactSide SideOf(const Located<std::string>& text) {
    const std::size_t dot = text.value.find('.');
    const std::string name = text.value.substr(0, dot);
    if (const int body = IndexOf(entry_.entities, name); body >= 0 && dot == std::string::npos)
      return {.body = physics::BodyIndex(body)};
    const physics::HandIndex hand(IndexOf(entry_.hands, name));
    if (hand == physics::kNone) {
      errors_.AddUnknownName(text.where, fmt::format("unknown name '{}'", text.value), text.value,
                             Names());
      return {};
    }
    const physics::HandModel& model = scenario_.scene.hand(hand).model;
    const std::string side = dot == std::string::npos ? "" : text.value.substr(dot + 1);
    const auto set = std::ranges::find(model.sensor_sets, side);
    if (set == model.sensor_sets.end()) {
      errors_.AddUnknownName(
          text.where,
          fmt::format("expected a side of '{0}' like '{0}.thumb', found '{1}'", name, text.value),
          side, model.sensor_sets);
      return {};
    }
    const int link = static_cast<int>(set - model.sensor_sets.begin());
    return {.hand = hand, .link = physics::LinkIndex(link == model.palm_sensor_set ? -1 : link)};
  }

  ClosedFormRecording Play(Kinematics& kinematics, FormulaScope scope,
                           const SamplingYaml& sampling) {
    ClosedFormRecording recording{
        .sampling = fmt::format("{} Hz{}", sampling.hz, sampling.lost ? ", frames lost" : ""),
        .scenario = scenario_};
    recording.scenario.sensing.sensing_hz = sampling.hz;
    double& t_s = scope.AddVariable("t");
    double& n = scope.AddVariable("n");
    const LocatedFormula lost = Compiled(scope, sampling.lost);
    recording.end = std::lround(entry_.lasts_s * kRate_hz) + 1;
    for (grammar::Tick tick = 1; tick < recording.end; ++tick) {
      if (tick * sampling.hz / kRate_hz == (tick - 1) * sampling.hz / kRate_hz) continue;
      t_s = static_cast<double>(tick) / kRate_hz;
      if (!lost.value || lost.value->Value() == 0) recording.frames.push_back(kinematics.At(tick));
      ++n;
    }
    return recording;
  }

  const std::string& path_;
  const YamlDocument& document_;
  DiagnosticList errors_;
  ClosedFormYaml entry_;
  scenario::Scenario scenario_;
};

}  // namespace

Result<ClosedForm> ReadClosedForm(const std::string& path) {
  const Result<YamlDocument> document = ReadYamlFile(path);
  if (!document) return tl::unexpected(document.error());
  return Reader(path, *document).Read();
}

Result<ClosedForm> ReadClosedFormText(const std::string& path, std::string text) {
  const Result<YamlDocument> document = ParseYaml(path, std::move(text));
  if (!document) return tl::unexpected(document.error());
  return Reader(path, *document).Read();
}

std::vector<std::string> ClosedFormFiles(const std::string& folder) {
  std::vector<std::string> files;
  for (const std::string& name : NamesIn(folder, kEnding))
    files.push_back(folder + "/" + name + kEnding);
  return files;
}

}  // namespace prehend::witnesses
