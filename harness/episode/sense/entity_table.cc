// SPDX-License-Identifier: Apache-2.0
// Tested by tests/harness/scenario/read/read_scenario_test.cc and
// tests/harness/episode/sense/sensing_test.cc
#include "harness/episode/sense/entity_table.h"

#include <algorithm>

#include "harness/scenario/scenario/scenario.h"

namespace prehend::episode {

namespace {

/// The entity that stands for the person whose hand this is, her head; otherwise kNoEntity.
int PersonOf(const physics::Scene& scene, physics::HandIndex hand) {
  for (const physics::Person& person : scene.persons) {
    if (person.right_hand == hand || person.left_hand == hand) return person.head.number();
  }
  return grammar::kNoEntity;
}

}  // namespace

std::vector<std::string> StyleNames(const physics::Scene& scene) {
  std::vector<std::string> names;
  for (const physics::Hand& hand : scene.hands) {
    for (const physics::GraspStyle& style : hand.model.styles) {
      if (std::ranges::find(names, style.name) == names.end()) names.push_back(style.name);
    }
  }
  return names;
}

namespace {

struct ShapeSeen {
  grammar::Shape operator()(const physics::Box& box) const { return grammar::Box{box.size_m / 2}; }
  grammar::Shape operator()(const physics::Sphere& sphere) const {
    return grammar::Ball{sphere.radius_m};
  }
  grammar::Shape operator()(const physics::Cylinder& cylinder) const {
    return grammar::Cylinder{cylinder.radius_m, cylinder.length_m / 2};
  }
  grammar::Shape operator()(const physics::Capsule& capsule) const {
    return grammar::Capsule{capsule.radius_m, capsule.length_m / 2};
  }
  grammar::Shape operator()(const physics::Hull& hull) const {
    return grammar::Hull{hull.corners_m};
  }
};

/// Empty if it fills its bounding box.
grammar::Solid SolidOf(const physics::Body& body) {
  const bool is_box = body.shapes.size() == 1 &&
                      std::holds_alternative<physics::Box>(body.shapes.front().shape) &&
                      body.shapes.front().X_BS.q.isApprox(Eigen::Quaterniond::Identity());
  if (is_box) return {};
  std::vector<grammar::SolidPart> parts;
  for (const physics::PlacedShape& part : body.shapes)
    parts.push_back({std::visit(ShapeSeen{}, part.shape), part.X_BS.p_m, part.X_BS.q});
  return grammar::Solid(std::move(parts));
}

}  // namespace

grammar::EntityTable MakeEntityTable(const scenario::Scenario& scenario) {
  grammar::EntityTable entity_table;
  entity_table.ticks_per_second = scenario.scene.world.rate_hz;
  for (std::size_t i = 0; i < scenario.scene.bodies.size(); ++i) {
    const physics::Body& body = scenario.scene.bodies[i];
    const physics::LocalBox box = physics::BoundingBox(body);
    grammar::EntityInfo& member = entity_table.entities.emplace_back();
    member.name = body.name;
    member.classes = scenario::ClassesOf(scenario, i);
    member.part_of = scenario.body_part_of[i];
    member.p_BC_m = box.p_BC_m;
    member.half_size_m = box.half_size_m;
    member.solid = SolidOf(body);
    member.round = body.abstract == physics::Abstract::kRegion &&
                   std::holds_alternative<physics::Sphere>(body.shapes.front().shape);
    member.mass_kg = body.fixed ? 0 : body.mass_kg;
  }
  for (std::size_t i = 0; i < scenario.scene.hands.size(); ++i) {
    const physics::Hand& hand = scenario.scene.hands[i];
    grammar::EntityInfo& member = entity_table.entities.emplace_back();
    member.name = hand.name;
    member.part_of = PersonOf(scenario.scene, physics::HandIndex(i));
    member.classes = {"Hand", "Entity"};
    member.half_size_m = hand.model.palm_size_m / 2;
    member.sensor_sets = hand.model.sensor_sets;
    member.strength_n = hand.model.translation.limit;
  }
  entity_table.styles = StyleNames(scenario.scene);
  return entity_table;
}

}  // namespace prehend::episode
