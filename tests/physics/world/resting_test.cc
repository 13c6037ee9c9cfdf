// SPDX-License-Identifier: Apache-2.0
// What lies on a held thing, or under it, rests there by friction alone, and slides where friction
// ends: physics/bullet/core/friction_anchors.h.
#include <gtest/gtest.h>

#include "tests/physics/tabletop.h"

namespace prehend::physics {
namespace {

constexpr int kOther = 2;

/// Takes the object from the side, lifts it, and waits.
Script Keep(double lift_m, double wait_s) {
  Script script;
  const auto add = [&](StepAction action, double over_s) {
    script.stages.push_back({{{HandIndex(0), std::move(action), over_s}}});
  };
  add(ReachStep{"object", "wrap", Approach::kSide}, 1.2);
  add(TriggerStep{1}, 0.6);
  if (lift_m > 0) add(MoveStep{{0, 0, lift_m}}, 1);
  add(WaitStep{}, wait_s);
  return script;
}

Scene BoxWith(Shape shape, double mass_kg, double friction, double above_box_m) {
  Scene scene = MakeScene(Tabletop{.shape = Box{{0.06, 0.06, 0.14}}, .mass_kg = 0.3});
  const Eigen::Vector3d at_m = scene.bodies[kObject].X_WB.p_m;
  scene.bodies.push_back({.name = "other",
                          .shapes = {{std::move(shape), {}}},
                          .mass_kg = mass_kg,
                          .friction = friction,
                          .X_WB = {at_m + Eigen::Vector3d(0, 0, above_box_m)}});
  return scene;
}

struct Creep {
  double moved_m = 0, turned_deg = 0;
};

/// Of the other body against `base`, from one time to the end.
Creep CreepOn(int base, Simulation& simulation, double from_s) {
  std::optional<Pose> begin;
  Creep creep;
  while (simulation.Step()) {
    const Snapshot& now = simulation.snapshot();
    if (now.tick < from_s * 480) continue;
    const Pose pose = now.bodies[base].X_WB.inverse() * now.bodies[kOther].X_WB;
    if (!begin) begin = pose;
    creep.moved_m = std::max(creep.moved_m, (pose.p_m - begin->p_m).norm());
    creep.turned_deg = std::max(creep.turned_deg,
                                RotationVector(pose.q * begin->q.conjugate()).norm() / kRadPerDeg);
  }
  return creep;
}

TEST(Resting, WhatLiesOnAHeldThingDoesNotCreep) {
  for (const auto& [size_m, mass_kg] : {std::pair{0.03, 0.05}, {0.05, 0.5}}) {
    Simulation simulation(BoxWith(Box{{size_m, size_m, size_m}}, mass_kg, 0.8, 0.07 + size_m / 2),
                          Keep(0.1, 11));
    const Creep creep = CreepOn(kObject, simulation, 3.5);
    EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kCompleted);
    EXPECT_LT(creep.moved_m, 0.0005) << mass_kg << " kg";
    EXPECT_LT(creep.turned_deg, 0.5) << mass_kg << " kg";
  }
}

TEST(Resting, WhatLiesUnderAHeldThingDoesNotCreep) {
  Scene scene = BoxWith(Box{{0.3, 0.3, 0.02}}, 0.15, 0.8, -0.08);
  for (const int i : {kObject, kOther}) scene.bodies[i].X_WB.p_m.z() += 0.02;
  Simulation simulation(std::move(scene), Keep(0, 10));
  EXPECT_LT(CreepOn(kTable, simulation, 2).moved_m, 0.003);
}

TEST(Resting, WhatLiesOnATippedThingSlidesWhereFrictionEnds) {
  // The held box is turned by 15 degrees: friction angles are 5 and 27 degrees.
  for (const auto& [friction, slides] : {std::pair{0.11, true}, {0.64, false}}) {
    Scene scene = BoxWith(Box{{0.03, 0.03, 0.03}}, 0.05, friction, 0.085);
    Script script = Keep(0.1, 1);
    script.stages.push_back({{{HandIndex(0), TurnHandStep{{15 * kRadPerDeg, 0, 0}}, 1}}});
    script.stages.push_back({{{HandIndex(0), WaitStep{}, 2}}});
    Simulation simulation(std::move(scene), script);
    const double moved_m = CreepOn(kObject, simulation, 3.5).moved_m;
    if (slides)
      EXPECT_GT(moved_m, 0.03);
    else
      EXPECT_LT(moved_m, 0.0005);
  }
}

/// A board on four cups of 0.1 kg, which stand on the table.
TEST(Resting, ABoardOnFourLooseFeetStandsStill) {
  for (const auto& [mass_kg, most_m] : {std::pair{1.0, 0.001}, {2.0, 0.002}}) {
    Scene scene = MakeScene(Tabletop{.shape = Box{{0.5, 0.5, 0.03}}, .mass_kg = mass_kg});
    scene.hands.clear();
    const Pose X_WB = {{0, 0, kTop_m + 0.115}};
    scene.bodies[kObject].X_WB = X_WB;
    for (const double x_m : {-0.2, 0.2})
      for (const double y_m : {-0.2, 0.2})
        scene.bodies.push_back({.name = "cup",
                                .shapes = {{Cylinder{0.03, 0.1}, {}}},
                                .mass_kg = 0.1,
                                .friction = 0.8,
                                .X_WB = {{x_m, y_m, kTop_m + 0.05}}});
    Script script;
    script.settle_s = 30;
    Simulation simulation(std::move(scene), script);
    double moved_m = 0;
    while (simulation.Step())
      moved_m =
          std::max(moved_m, (simulation.snapshot().bodies[kObject].X_WB.p_m - X_WB.p_m).norm());
    EXPECT_EQ(simulation.snapshot().tick, 30 * 480);
    EXPECT_LT(moved_m, most_m) << mass_kg << " kg";
  }
}

}  // namespace
}  // namespace prehend::physics
