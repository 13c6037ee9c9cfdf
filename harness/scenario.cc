// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/read_scenario_test.cc
#include "harness/scenario.h"

#include "harness/sensing.h"

namespace prehend::harness {

const std::vector<std::string>& CameraWords() {
  static const std::vector<std::string> words = {"front", "left", "right", "top", "three_quarter"};
  return words;
}

namespace {

/// What hangs on a joint is neither fixed nor can it be picked up.
const char* MobilityOf(const physics::Scene& scene, int body) {
  if (scene.bodies[static_cast<std::size_t>(body)].fixed) return "Fixed";
  return physics::MovesFreely(scene, body) ? "Movable" : "Jointed";
}

std::vector<std::string> ClassesOf(const Scenario& scenario, std::size_t body) {
  const std::string& own = scenario.body_classes[body];
  const physics::Body& is = scenario.scene.bodies[body];
  if (is.grains) return {own, "Grains", "Entity"};
  if (!physics::IsThing(is)) return {own, "Entity"};
  return {own, MobilityOf(scenario.scene, static_cast<int>(body)), "Thing", "Entity"};
}

}  // namespace

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
