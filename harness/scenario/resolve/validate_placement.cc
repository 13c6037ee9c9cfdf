// SPDX-License-Identifier: Apache-2.0
// Sort and sweep along x, then separating axes. Each body is reported once, so that the output
// stays readable. Tested by tests/harness/scenario/read/read_scenario_test.cc
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "harness/scenario/resolve/penetration.h"
#include "harness/scenario/resolve/resolve.h"
#include "physics/scene/geometry.h"
#include "physics/scene/joint.h"
#include "physics/scene/run_limits.h"

namespace prehend::scenario {
namespace {

constexpr double kMaxOverlap_m = 0.001;  // hidden by the collision margins

/// A body or a hand.
struct Occupant {
  std::string name;
  Where where;
  bool hand = false;
  bool fixed = false;
  bool person = false;
  bool grains = false;
  std::vector<PlacedSolid> solids;
  Eigen::AlignedBox3d bounds;
};

void AddSolid(const physics::Shape& shape, const physics::Pose& X_WS, Occupant& occupant) {
  occupant.solids.push_back({shape, X_WS});
  occupant.bounds.extend(physics::WorldBounds(shape, X_WS));
}

Occupant OccupantOf(const physics::Body& body, Where where) {
  Occupant occupant{.name = body.name,
                    .where = where,
                    .fixed = body.fixed,
                    .person = body.kinematic,
                    .solids = {},
                    .bounds = {}};
  if (body.abstract != physics::Abstract::kNot) return occupant;  // it takes no space
  for (const auto& placed : body.shapes) AddSolid(placed.shape, body.X_WB * placed.X_BS, occupant);
  if (!body.grains) return occupant;
  occupant.grains = true;
  for (const Eigen::Vector3d& p_WG_m : body.grains->p_WG_m)
    AddSolid(physics::Sphere{body.grains->radius_m}, {p_WG_m}, occupant);
  return occupant;
}

/// Palm and fingers, open in the first style.
Occupant OccupantOf(const physics::Hand& hand, Where where) {
  Occupant occupant{.name = hand.name, .where = where, .hand = true, .solids = {}, .bounds = {}};
  const physics::HandModel& model = hand.model;
  AddSolid(physics::Box{model.palm_size_m}, hand.X_WH, occupant);
  const std::vector<double> joints = model.styles.empty()
                                         ? std::vector<double>(model.links.size())
                                         : physics::JointTargets(model.styles[0], 0);
  const std::vector<physics::Pose> poses = physics::LinkPoses(model, joints);
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const physics::HandLink& link = model.links[i];
    AddSolid(physics::Box{{link.length_m, 2 * link.half_width_m, 2 * link.half_thickness_m}},
             hand.X_WH * poses[i], occupant);
  }
  return occupant;
}

double Depth(const Occupant& a, const Occupant& b) {
  double deepest = 0;
  if (!a.bounds.intersects(b.bounds)) return 0;
  for (const PlacedSolid& solid_a : a.solids) {
    for (const PlacedSolid& solid_b : b.solids)
      deepest = std::max(deepest, Penetration(solid_a, solid_b));
  }
  return deepest;
}

/// Bodies on the two sides of a joint never collide: a drawer may overlap its cabinet.
bool Joined(const physics::Scene& scene, std::size_t a, std::size_t b) {
  if (std::max(a, b) >= scene.bodies.size()) return false;
  return physics::NeverTouch(scene, physics::BodyIndex(a), physics::BodyIndex(b));
}

/// A person does not collide with fixed bodies, hands and other persons.
bool MayOverlap(const Occupant& a, const Occupant& b) {
  if (!a.person) return b.person && MayOverlap(b, a);
  return b.person || b.hand || b.fixed;
}

void Complain(const Occupant& later, const Occupant& earlier, double depth_m,
              DiagnosticList& errors) {
  const double depth_mm = depth_m * 1000;
  if (later.person) {
    errors.Add(
        later.where,
        fmt::format("'{}' starts inside '{}', {:.0f} mm deep", later.name, earlier.name, depth_mm),
        "move the person");
  } else if (later.hand) {
    errors.Add(
        later.where,
        fmt::format("actor '{}' starts inside '{}', {:.0f} mm deep", later.name, earlier.name,
                    depth_mm),
        "start the hand in free space; the thumb of an open hand hangs 10 cm below its palm");
  } else if (earlier.grains || later.grains) {
    errors.Add(later.where,
               fmt::format("'{}' overlaps '{}' by {:.0f} mm", later.name, earlier.name, depth_mm),
               "grains are placed around the vessel's vertical axis; keep it free");
  } else {
    errors.Add(later.where,
               fmt::format("'{}' overlaps '{}' by {:.0f} mm", later.name, earlier.name, depth_mm),
               fmt::format("'on: {}' with at_m: [x, y] puts it on top", earlier.name));
  }
}

/// Of a body's place. After the entities come the parts of the persons.
Where WhereOf(const ScenarioYaml& entry, const physics::Scene& scene, std::size_t body) {
  if (body < entry.entities.size()) return PlaceOf(entry.entities[body].value);
  Where where;
  for (std::size_t i = 0; i < scene.persons.size(); ++i) {
    if (scene.persons[i].head <= physics::BodyIndex(body))
      where = entry.persons[i].value.at_m.where;
  }
  return where;
}

}  // namespace

void ValidateDistances(const ScenarioYaml& entry, const physics::Scene& scene,
                       DiagnosticList& errors) {
  const auto check = [&](Where where, const Eigen::Vector3d& p_W_m) {
    if (p_W_m.norm() <= physics::kMaxDistance_m) return;
    errors.Add(where,
               fmt::format("at_m: expected a place within {} m of the origin, found one {:.1f} "
                           "m from it",
                           physics::kMaxDistance_m, p_W_m.norm()));
  };
  for (std::size_t i = 0; i < entry.entities.size(); ++i)
    check(WhereOf(entry, scene, i), scene.bodies[i].X_WB.p_m);
  for (const auto& person : entry.persons) check(person.value.at_m.where, person.value.at_m.value);
  for (const auto& hand : entry.hands) check(hand.value.at_m.where, hand.value.at_m.value);
}

void ValidatePlacement(const ScenarioYaml& entry, const physics::Scene& scene,
                       DiagnosticList& errors) {
  std::vector<Occupant> occupants;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    occupants.push_back(OccupantOf(scene.bodies[i], WhereOf(entry, scene, i)));
  }
  for (std::size_t i = 0; i < scene.hands.size(); ++i) {
    occupants.push_back(OccupantOf(scene.hands[i], entry.hands[i].value.at_m.where));
  }
  std::vector<std::size_t> by_x(occupants.size());
  for (std::size_t i = 0; i < by_x.size(); ++i) by_x[i] = i;
  std::sort(by_x.begin(), by_x.end(), [&](std::size_t a, std::size_t b) {
    return std::tuple(occupants[a].bounds.min().x(), a) <
           std::tuple(occupants[b].bounds.min().x(), b);
  });

  std::set<std::size_t> complained;
  for (std::size_t i = 0; i < by_x.size(); ++i) {
    for (std::size_t j = i + 1; j < by_x.size(); ++j) {
      const auto [earlier, later] = std::minmax(by_x[i], by_x[j]);
      if (occupants[by_x[j]].bounds.min().x() > occupants[by_x[i]].bounds.max().x()) break;
      if (complained.contains(later)) continue;
      const double depth_m = Depth(occupants[earlier], occupants[later]);
      if (depth_m <= kMaxOverlap_m || Joined(scene, earlier, later)) continue;
      if (MayOverlap(occupants[earlier], occupants[later])) continue;
      Complain(occupants[later], occupants[earlier], depth_m, errors);
      complained.insert(later);
    }
  }
}

}  // namespace prehend::scenario
