// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/read_scenario_test.cc
#include "harness/scenario.h"

#include <fmt/format.h>

#include <algorithm>

#include "harness/kinds.h"
#include "harness/sensing.h"

namespace prehend::harness {

const std::vector<std::string>& CameraWords() {
  static const std::vector<std::string> words = {"front", "left", "right", "top", "three_quarter"};
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
  if (std::ranges::find(cameras, camera) != cameras.end()) return std::nullopt;
  return fmt::format("camera: expected one of {}, found '{}'", fmt::join(cameras, ", "), camera);
}

grammar::Cast MakeCast(const Scenario& scenario) {
  grammar::Cast cast;
  cast.ticks_per_second = scenario.scene.world.rate_hz;
  for (std::size_t i = 0; i < scenario.scene.bodies.size(); ++i) {
    const physics::Body& body = scenario.scene.bodies[i];
    const physics::LocalBox box = physics::BoundingBox(body);
    grammar::CastMember& member = cast.entities.emplace_back();
    member.name = body.name;
    member.classes = ClassesOf(scenario, i);
    member.part_of = scenario.body_part_of[i];
    member.p_BC_m = box.p_BC_m;
    member.half_size_m = box.half_size_m;
    member.round = body.abstract == physics::Abstract::kRegion &&
                   std::holds_alternative<physics::Sphere>(body.shapes.front().shape);
    member.mass_kg = body.fixed ? 0 : body.mass_kg;
  }
  for (const physics::Hand& hand : scenario.scene.hands) {
    grammar::CastMember& member = cast.entities.emplace_back();
    member.name = hand.name;
    member.classes = {"Hand", "Entity"};
    member.half_size_m = hand.model.palm_size_m / 2;
    member.sensor_sets = hand.model.sensor_sets;
    member.strength_n = hand.model.translation.limit;
  }
  cast.styles = StyleNames(scenario.scene);
  return cast;
}

}  // namespace prehend::harness
