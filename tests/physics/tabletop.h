// SPDX-License-Identifier: Apache-2.0
// A table, one object and one hand, for tests of whole runs. The table's top is at 0.76 m.
#pragma once

#include <cmath>
#include <random>

#include "physics/simulation.h"
#include "tests/physics/library_hand.h"

namespace prehend::physics {

inline constexpr double kTop_m = 0.76;
inline constexpr int kTable = 0, kObject = 1;

struct Tabletop {
  Shape shape = Box{{0.07, 0.07, 0.20}};
  double mass_kg = 0.4;
  double friction = 0.8;
  Eigen::Vector2d at_m = {0.2, 0.1};
  double yaw_rad = 0;
  Eigen::Vector3d hand_at_m = {-0.2, -0.2, 1.05};
  std::string hand = "human_right";
};

inline double HeightOf(const Shape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) return box->size_m.z();
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return 2 * sphere->radius_m;
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) return cylinder->length_m;
  const auto& capsule = std::get<Capsule>(shape);
  return capsule.length_m + 2 * capsule.radius_m;
}

inline Scene MakeScene(const Tabletop& t) {
  Scene scene;
  scene.bodies.push_back({.name = "table",
                          .shapes = {{Box{{1.2, 0.8, 0.04}}, {}}},
                          .fixed = true,
                          .X_WB = {{0, 0, 0.74}}});
  const Eigen::Quaterniond yaw(Eigen::AngleAxisd(t.yaw_rad, Eigen::Vector3d::UnitZ()));
  scene.bodies.push_back({.name = "object",
                          .shapes = {{t.shape, {}}},
                          .mass_kg = t.mass_kg,
                          .friction = t.friction,
                          .rolling_friction = std::holds_alternative<Sphere>(t.shape) ? 0.006 : 0,
                          .X_WB = {{t.at_m.x(), t.at_m.y(), kTop_m + HeightOf(t.shape) / 2}, yaw}});
  scene.hands.push_back({"hand", LibraryHand(t.hand), {t.hand_at_m}});
  return scene;
}

struct PickAndPlace {
  std::string style = "wrap";
  Approach approach = Approach::kAuto;
  Eigen::Vector2d to_m = {0.2, -0.3};
};

inline Script MakeScript(const PickAndPlace& p) {
  Script script;
  const auto add = [&](StepAction action, double over_s) {
    script.stages.push_back({{{HandIndex(0), action, over_s}}});
  };
  add(ReachStep{"object", p.style, p.approach}, 0.8);
  add(TriggerStep{1}, 0.6);
  add(MoveStep{{0, 0, 0.25}}, 0.6);
  add(CarryStep{p.to_m}, 1.0);
  add(PlaceStep{"table"}, 0.6);
  add(TriggerStep{0}, 0.45);
  add(RetreatStep{0.2}, 0.6);
  return script;
}

struct Outcome {
  RunStatus status;
  double rise_m = 0;         ///< highest above the start
  double pushed_m = 0;       ///< farthest from the start before the hand closes
  double miss_m = 0;         ///< horizontal distance from where it should be
  double height_m = 0;       ///< of the centre, at the end, above that of a standing object
  double tilt_deg = 0;       ///< at the end
  double speed_m_per_s = 0;  ///< at the end
  std::uint64_t hash = 0;

  bool Placed(bool round = false) const {
    return status.kind == RunStatus::Kind::kCompleted && rise_m > 0.2 && miss_m < 0.05 &&
           std::abs(height_m) < 0.005 && speed_m_per_s < 0.02 && (round || tilt_deg < 5);
  }
};

inline Outcome Perform(const Tabletop& tabletop, const PickAndPlace& task) {
  Simulation simulation(MakeScene(tabletop), MakeScript(task));
  const Pose start = simulation.snapshot().bodies[kObject].X_WB;
  Outcome outcome;
  while (simulation.Step()) {
    const Snapshot& now = simulation.snapshot();
    const Eigen::Vector3d moved = now.bodies[kObject].X_WB.p_m - start.p_m;
    outcome.rise_m = std::max(outcome.rise_m, moved.z());
    if (now.hands[0].trigger == 0 && now.tick < 0.8 * 480)
      outcome.pushed_m = std::max(outcome.pushed_m, moved.norm());
  }
  const BodyState& end = simulation.snapshot().bodies[kObject];
  outcome.status = simulation.status();
  outcome.miss_m = (end.X_WB.p_m.head<2>() - task.to_m).norm();
  outcome.height_m = end.X_WB.p_m.z() - start.p_m.z();
  outcome.tilt_deg =
      std::acos(std::clamp((end.X_WB.q * Eigen::Vector3d::UnitZ()).z(), -1.0, 1.0)) * 57.2958;
  outcome.speed_m_per_s = end.v_WB_m_per_s.norm();
  outcome.hash = simulation.state_hash();
  return outcome;
}

inline std::ostream& operator<<(std::ostream& out, const Outcome& o) {
  return out << "rise " << o.rise_m << " m, pushed " << o.pushed_m << " m, miss " << o.miss_m
             << " m, height " << o.height_m << " m, tilt " << o.tilt_deg << " deg, speed "
             << o.speed_m_per_s << " m/s " << o.status.reason;
}

}  // namespace prehend::physics
