// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "harness/episode/episodes/recordings.h"
#include "harness/scenario/scenario/scenario.h"

namespace prehend::episode {
namespace {

/// What has no extent is drawn this large.
constexpr double kLeastSize_m = 0.002;

bool IsHandEntity(const grammar::EntityInfo& entity) { return entity.classes.front() == "Hand"; }

/// What encloses these points, where they are no hull of their own.
physics::PlacedShape BoxAround(const std::vector<Eigen::Vector3d>& points_m) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : points_m) box.extend(point);
  physics::PlacedShape placed{physics::Box{box.sizes().cwiseMax(kLeastSize_m)}, {}};
  placed.X_BS.p_m = box.center();
  return placed;
}

/// A shape in its own frame S.
struct ShapeShown {
  physics::PlacedShape operator()(const grammar::Box& box) const {
    return {physics::Box{2 * box.half_size_m}, {}};
  }
  physics::PlacedShape operator()(const grammar::Ball& ball) const {
    return {physics::Sphere{ball.radius_m}, {}};
  }
  physics::PlacedShape operator()(const grammar::Cylinder& cylinder) const {
    return {physics::Cylinder{cylinder.radius_m, 2 * cylinder.half_length_m}, {}};
  }
  physics::PlacedShape operator()(const grammar::Capsule& capsule) const {
    return {physics::Capsule{capsule.radius_m, 2 * capsule.half_length_m}, {}};
  }
  physics::PlacedShape operator()(const grammar::Hull& hull) const {
    physics::MadeHull made = physics::MakeHull(hull.points_m);
    if (!made.hull) return BoxAround(hull.points_m);
    return {std::move(*made.hull), {}};
  }
};

std::vector<physics::PlacedShape> ShapesOf(const grammar::EntityInfo& entity) {
  std::vector<physics::PlacedShape> shapes;
  for (const grammar::SolidPart& part : entity.solid.parts()) {
    physics::PlacedShape shape = std::visit(ShapeShown{}, part.shape);
    shape.X_BS = physics::Pose{part.p_BS_m, part.q_BS} * shape.X_BS;
    shapes.push_back(std::move(shape));
  }
  if (!shapes.empty()) return shapes;
  physics::PlacedShape whole{physics::Box{(2 * entity.half_size_m).cwiseMax(kLeastSize_m)}, {}};
  if (entity.round) whole.shape = physics::Sphere{entity.half_size_m.maxCoeff()};
  whole.X_BS.p_m = entity.p_BC_m;
  return {std::move(whole)};
}

physics::Abstract AbstractOf(const std::vector<std::string>& classes) {
  using physics::Abstract;
  const auto is = [&](const char* name) {
    return std::ranges::find(classes, name) != classes.end();
  };
  if (!is("Abstract")) return Abstract::kNot;
  if (is("Camera")) return Abstract::kCamera;
  if (is("Light")) return Abstract::kLight;
  return is("GazeTarget") ? Abstract::kGazeTarget : Abstract::kRegion;
}

physics::Hand HandOf(const grammar::EntityInfo& entity, const std::vector<std::string>& styles) {
  physics::Hand hand{.name = entity.name, .model = {}, .X_WH = {}};
  hand.model.name = "palm";
  if (!entity.half_size_m.isZero())
    hand.model.palm_size_m = (2 * entity.half_size_m).cwiseMax(kLeastSize_m);
  hand.model.sensor_sets = entity.sensor_sets;
  for (const std::string& style : styles) hand.model.styles.push_back({.name = style});
  return hand;
}

/// Where an entity of the recording is in the scene.
struct Placeholder {
  int body = -1, hand = -1;
};

std::vector<Placeholder> PlaceholdersOf(const grammar::EntityTable& table) {
  std::vector<Placeholder> all;
  int bodies = 0, hands = 0;
  for (const grammar::EntityInfo& entity : table.entities)
    all.push_back(IsHandEntity(entity) ? Placeholder{.hand = hands++}
                                       : Placeholder{.body = bodies++});
  return all;
}

physics::BodyState StateOf(const grammar::EntitySample& look) {
  return {.X_WB = {look.p_WB_m, look.q_WB},
          .v_WB_m_per_s = look.v_WB_m_per_s,
          .w_WB_rad_per_s = look.w_WB_rad_per_s,
          .asleep = look.asleep};
}

}  // namespace

scenario::Scenario PlaceholderFor(const EpisodeHeader& header) {
  const grammar::EntityTable& table = header.entity_table;
  const std::vector<Placeholder> places = PlaceholdersOf(table);
  scenario::Scenario scenario;
  scenario.name = header.episode;
  scenario.grammar = header.grammar;
  scenario.scene.world.rate_hz = static_cast<int>(table.ticks_per_second);
  for (const grammar::EntityInfo& entity : table.entities) {
    if (IsHandEntity(entity)) {
      scenario.scene.hands.push_back(HandOf(entity, table.styles));
      continue;
    }
    physics::Body& body = scenario.scene.bodies.emplace_back();
    body.name = entity.name;
    body.shapes = ShapesOf(entity);
    body.abstract = AbstractOf(entity.classes);
    body.fixed = std::ranges::find(entity.classes, "Fixed") != entity.classes.end();
    body.mass_kg = entity.mass_kg;
    scenario.body_classes.push_back(entity.classes.front());
    scenario.body_part_of.push_back(entity.part_of == grammar::kNoEntity
                                        ? grammar::kNoEntity
                                        : places[static_cast<std::size_t>(entity.part_of)].body);
    for (std::size_t i = 1; i < entity.classes.size(); ++i) {
      const std::string& below = entity.classes[i - 1];
      if (scenario::IsScenarioBuiltinClass(below)) break;
      if (std::ranges::find(scenario.base_classes, below, &scenario::BaseClass::name) ==
          scenario.base_classes.end())
        scenario.base_classes.push_back({below, entity.classes[i]});
    }
  }
  return scenario;
}

physics::Snapshot PlaceholderSnapshotAt(const EpisodeHeader& header, const EpisodeFrame& frame) {
  const grammar::EntityTable& table = header.entity_table;
  const std::vector<Placeholder> places = PlaceholdersOf(table);
  physics::Snapshot snapshot;
  snapshot.tick = frame.tick;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const physics::BodyState state = StateOf(frame.entities[i]);
    if (places[i].body >= 0) {
      snapshot.bodies.push_back(state);
    } else {
      physics::HandState& hand = snapshot.hands.emplace_back();
      hand.palm = state;
      hand.palm.asleep = false;
      hand.X_WTarget = state.X_WB;
    }
  }
  for (std::size_t i = 0; i < frame.hands.size(); ++i) {
    snapshot.hands[i].trigger = frame.hands[i].trigger;
    snapshot.hands[i].style = frame.hands[i].style;
  }
  const auto side = [&](int entity) -> physics::ContactSide {
    const Placeholder& place = places[static_cast<std::size_t>(entity)];
    return {.body = physics::BodyIndex(place.body), .hand = physics::HandIndex(place.hand)};
  };
  for (const grammar::Touch& touch : frame.touches) {
    if (touch.nhat_BA_W.isZero()) continue;  // where it is is not known
    snapshot.contacts.push_back(
        {.a = side(touch.a),
         .b = side(touch.b),
         .p_W_m = touch.p_W_m,
         .nhat_BA_W = touch.nhat_BA_W,
         .distance_m = 0,
         .normal_impulse_n_s = touch.normal_force_n / static_cast<double>(table.ticks_per_second)});
  }
  return snapshot;
}

}  // namespace prehend::episode
