// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/scenario/scenario_test.cc,
// tests/harness/scenario/read/read_scenario_test.cc and
// tests/harness/scenario/resolve/classes_test.cc
#include "harness/scenario/scenario/scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace prehend::scenario {
namespace {

constexpr double kFarthest_m = 100, kNearest_m = 0.01;
constexpr double kNarrowest_deg = 5, kWidest_deg = 120;

/// Reads a number and what has to follow it; false if there is something else.
bool Take(const char*& at, const char* end, double& value) {
  const auto [stop, error] = std::from_chars(at, end, value);
  at = stop;
  return error == std::errc() && std::isfinite(value);
}

bool Take(const char*& at, const char* end, char wanted) { return at != end && *at++ == wanted; }

bool Take(const char*& at, const char* end, Eigen::Vector3d& place_m) {
  return Take(at, end, place_m.x()) && Take(at, end, ',') && Take(at, end, place_m.y()) &&
         Take(at, end, ',') && Take(at, end, place_m.z()) &&
         place_m.cwiseAbs().maxCoeff() <= kFarthest_m;
}

/// A body on a joint is neither fixed nor free to be picked up; only a slider or a hinge opens and
/// closes.
const char* MobilityOf(const physics::Scene& scene, physics::BodyIndex body) {
  if (scene.body(body).fixed) return "Fixed";
  const auto joint = std::ranges::find(scene.joints, body, &physics::Joint::body);
  if (joint == scene.joints.end()) return "Movable";
  const bool opens =
      joint->kind == physics::JointKind::kSlider || joint->kind == physics::JointKind::kHinge;
  return opens ? "Jointed" : "Attached";
}

std::vector<std::string> BuiltInClassesOf(const physics::Scene& scene, std::size_t body) {
  using physics::Abstract;
  const physics::Body& is = scene.bodies[body];
  switch (is.abstract) {
    case Abstract::kRegion:
      return {"Region", "Abstract", "Entity"};
    case Abstract::kGazeTarget:
      return {"GazeTarget", "Abstract", "Entity"};
    case Abstract::kCamera:
      return {"Camera", "Abstract", "Entity"};
    case Abstract::kLight:
      return {"Light", "Abstract", "Entity"};
    case Abstract::kNot:
      break;
  }
  if (is.grains) return {"Grains", "Entity"};
  const bool is_head = std::ranges::any_of(scene.persons, [&](const physics::Person& person) {
    return person.head == physics::BodyIndex(body);
  });
  if (is.kinematic && !is_head) return {"BodyPart", "Entity"};
  if (!physics::IsThing(is)) return {"Entity"};
  return {MobilityOf(scene, physics::BodyIndex(body)), "Thing", "Entity"};
}

struct NamedColor {
  std::string_view name;
  std::uint32_t rgb;
};

// Words name hues as people use them; lightnesses differ, so that two of them stay apart without
// colour, too.
constexpr std::array<NamedColor, 19> kWords = {{
    {"white", 0xF1F3F4},  {"black", 0x2B2D30},  {"grey", 0x8D949B},      {"gray", 0x8D949B},
    {"silver", 0xC3C9CE}, {"steel", 0xA7B0B8},  {"red", 0xC62828},       {"orange", 0xE8871E},
    {"yellow", 0xF2C71B}, {"green", 0x4CA64C},  {"blue", 0x2F6FC4},      {"purple", 0x7B4AA8},
    {"violet", 0x7B4AA8}, {"pink", 0xE79AB8},   {"brown", 0x7A5230},     {"beige", 0xDCC9A3},
    {"wooden", 0xC8A27C}, {"golden", 0xCFA23A}, {"turquoise", 0x36B5AC},
}};

constexpr std::array<NamedColor, 25> kClasses = {{
    {"MilkCarton", 0xE9F0F6}, {"JuiceCarton", 0xE8871E}, {"Carton", 0xC99C63},
    {"Box", 0xC99C63},        {"Crate", 0xB98A55},       {"Can", 0xA7B0B8},
    {"Cup", 0x3F7FB5},        {"Mug", 0x3F7FB5},         {"Bowl", 0xD9E2DC},
    {"Plate", 0xEEF1F0},      {"Tray", 0x6D7B86},        {"Pot", 0x5A636B},
    {"Jar", 0xB8D0CC},        {"Glass", 0xBFE0EA},       {"Bottle", 0x5E9C76},
    {"Spoon", 0xB9C1C7},      {"Table", 0xC8A27C},       {"SideTable", 0xB98F66},
    {"Cupboard", 0xB98F66},   {"Cabinet", 0xB98F66},     {"Drawer", 0xD9B98F},
    {"Door", 0xD9B98F},       {"Handle", 0x5A636B},      {"Egg", 0xF3E3C8},
    {"Soap", 0xE9B8C8},
}};

template <std::size_t kCount>
std::optional<std::uint32_t> Find(const std::array<NamedColor, kCount>& colors,
                                  std::string_view name) {
  const auto found = std::ranges::find(colors, name, &NamedColor::name);
  if (found == colors.end()) return std::nullopt;
  return found->rgb;
}

}  // namespace

std::optional<OwnCamera> ParseOwnCamera(const std::string& text) {
  OwnCamera camera;
  const char* at = text.data();
  const char* const end = at + text.size();
  if (!Take(at, end, camera.eye_m) || !Take(at, end, ':') || !Take(at, end, camera.look_at_m))
    return std::nullopt;
  if (at != end && (!Take(at, end, ':') || !Take(at, end, camera.view_deg))) return std::nullopt;
  const bool is_view = camera.view_deg >= kNarrowest_deg && camera.view_deg <= kWidest_deg &&
                       (camera.eye_m - camera.look_at_m).norm() >= kNearest_m;
  return at == end && is_view ? std::optional(camera) : std::nullopt;
}

std::vector<std::string> WithBaseClasses(const std::string& class_name,
                                         const std::vector<BaseClass>& base_classes) {
  std::vector<std::string> all = {class_name};
  while (all.size() <= base_classes.size()) {
    const auto found = std::ranges::find(base_classes, all.back(), &BaseClass::name);
    if (found == base_classes.end()) break;
    all.push_back(found->of);
  }
  return all;
}

std::vector<std::string> ClassesOf(const Scenario& scenario, std::size_t body) {
  std::vector<std::string> classes =
      WithBaseClasses(scenario.body_classes[body], scenario.base_classes);
  for (std::string& given : BuiltInClassesOf(scenario.scene, body))
    classes.push_back(std::move(given));
  return classes;
}

Scenario::Scenario() = default;
Scenario::Scenario(const Scenario& other) = default;
Scenario::Scenario(Scenario&& other) noexcept = default;
Scenario& Scenario::operator=(const Scenario& other) = default;
Scenario& Scenario::operator=(Scenario&& other) noexcept = default;
Scenario::~Scenario() = default;

grammar::Tick DefaultTolerance(const Scenario& scenario) {
  constexpr int kFrames = 2;
  const int sensing_hz = scenario.sensing.sensing_hz;
  return (kFrames * scenario.scene.world.rate_hz + sensing_hz - 1) / sensing_hz;
}

const std::vector<std::string>& CameraWords() {
  static const std::vector<std::string> words = {"front",         "left", "right",  "top",
                                                 "three_quarter", "hand", "action", "body"};
  return words;
}

std::vector<std::string> CamerasOf(const Scenario& scenario) {
  std::vector<std::string> cameras = CameraWords();
  for (const physics::Body& body : scenario.scene.bodies) {
    if (body.abstract == physics::Abstract::kCamera) cameras.push_back(body.name);
  }
  return cameras;
}

std::optional<std::string> WhyNoCamera(const Scenario& scenario, const std::string& camera) {
  const std::vector<std::string> cameras = CamerasOf(scenario);
  if (std::ranges::find(cameras, camera) != cameras.end() || ParseOwnCamera(camera))
    return std::nullopt;
  return fmt::format("camera: expected one of {}, or {}, found '{}'", fmt::join(cameras, ", "),
                     kOwnCameraForm, camera);
}

const std::vector<std::string>& ColorWords() {
  static const std::vector<std::string> words = [] {
    std::vector<std::string> all;
    for (const NamedColor& color : kWords) all.emplace_back(color.name);
    return all;
  }();
  return words;
}

std::optional<std::uint32_t> ColorOfText(std::string_view text) {
  if (!text.starts_with('#')) return Find(kWords, text);
  std::uint32_t rgb = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + 1, end, rgb, 16);
  if (text.size() != 7 || stop != end || error != std::errc()) return std::nullopt;
  return rgb;
}

std::optional<std::uint32_t> ColorInName(std::string_view name) {
  while (!name.empty()) {
    const std::size_t end = std::min(name.find('_'), name.size());
    if (const auto color = Find(kWords, name.substr(0, end))) return color;
    name.remove_prefix(std::min(end + 1, name.size()));
  }
  return std::nullopt;
}

std::optional<std::uint32_t> ColorOfClass(std::string_view class_name) {
  return Find(kClasses, class_name);
}

}  // namespace prehend::scenario
