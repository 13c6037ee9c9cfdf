// SPDX-License-Identifier: Apache-2.0
// A hand that holds still holds still, by friction alone: physics/bullet/core/friction_anchors.h.
// The bench of holding, bench/holding.py, does the same with 30 things for a minute.
#include <gtest/gtest.h>

#include "tests/physics/tabletop.h"

namespace prehend::physics {
namespace {

struct Way {
  double turned_deg = 0, moved_m = 0;
};

/// How far the object turns and moves, against the palm or in the world, between two times.
Way WayOf(Simulation& simulation, bool in_the_hand, double from_s, double to_s) {
  std::optional<Pose> begin;
  Way way;
  while (simulation.Step() && simulation.snapshot().tick < to_s * 480) {
    const Snapshot& now = simulation.snapshot();
    if (now.tick < from_s * 480) continue;
    const Pose& X_WB = now.bodies[kObject].X_WB;
    const Pose pose = in_the_hand ? now.hands[0].palm.X_WB.inverse() * X_WB : X_WB;
    if (!begin) begin = pose;
    way.turned_deg =
        std::max(way.turned_deg, RotationVector(pose.q * begin->q.conjugate()).norm() / kRadPerDeg);
    way.moved_m = std::max(way.moved_m, (pose.p_m - begin->p_m).norm());
  }
  return way;
}

/// Takes it, lifts it by so much, and holds it for 8 s.
Script Hold(const std::string& style, Approach approach, double lift_m) {
  Script script;
  const auto add = [&](StepAction action, double over_s) {
    script.stages.push_back({{{HandIndex(0), std::move(action), over_s}}});
  };
  add(ReachStep{"object", style, approach}, 0.8);
  add(TriggerStep{1}, 0.6);
  if (lift_m > 0) add(MoveStep{{0, 0, lift_m}}, 0.6);
  add(WaitStep{}, 8);
  return script;
}

TEST(Holding, WhatIsHeldInTheAirNeitherTurnsNorCreeps) {
  const struct {
    Shape shape;
    double mass_kg;
    std::string style;
    Approach approach;
  } cases[] = {{Box{{0.07, 0.07, 0.20}}, 0.4, "wrap", Approach::kSide},
               {Box{{0.06, 0.06, 0.14}}, 0.1, "pinch", Approach::kAbove},
               {Cylinder{0.033, 0.12}, 0.35, "wrap", Approach::kSide},
               {Sphere{0.035}, 0.2, "wrap", Approach::kAbove}};
  for (const auto& [shape, mass_kg, style, approach] : cases) {
    Simulation simulation(MakeScene(Tabletop{.shape = shape, .mass_kg = mass_kg}),
                          Hold(style, approach, 0.15));
    const Way way = WayOf(simulation, /*in_the_hand=*/true, 3, 10);
    EXPECT_LT(way.turned_deg, 0.1) << style << " " << mass_kg << " kg";
    EXPECT_LT(way.moved_m, 0.0001) << style << " " << mass_kg << " kg";
    EXPECT_GT(simulation.snapshot().bodies[kObject].X_WB.p_m.z(), kTop_m + 0.12) << "it is held";
  }
}

TEST(Holding, WhatIsHeldOnATableStaysThere) {
  for (const double mass_kg : {0.1, 0.3, 1.0, 1.5}) {
    Simulation simulation(MakeScene(Tabletop{.shape = Box{{0.06, 0.06, 0.14}}, .mass_kg = mass_kg}),
                          Hold("wrap", Approach::kSide, 0));
    const Way way = WayOf(simulation, /*in_the_hand=*/false, 2, 9.4);
    EXPECT_LT(way.moved_m, 0.00005) << mass_kg << " kg";
  }
}

TEST(Holding, FrictionBearsNoMoreThanItsLimit) {
  // Thumb and fingers press with some 30 N: 6 kg are too heavy.
  Simulation simulation(MakeScene(Tabletop{.mass_kg = 6}), Hold("wrap", Approach::kSide, 0.15));
  while (simulation.Step()) {
  }
  EXPECT_LT(simulation.snapshot().bodies[kObject].X_WB.p_m.z(), kTop_m + 0.105);
}

TEST(Holding, WhatIsPutDownLandsFlatAndIsNotPushed) {
  for (const double mass_kg : {0.05, 0.3, 0.8}) {
    Script script = MakeScript({.style = "wrap", .approach = Approach::kSide});
    Simulation simulation(MakeScene(Tabletop{.shape = Cylinder{0.033, 0.12}, .mass_kg = mass_kg}),
                          script);
    std::optional<Eigen::Vector3d> landed_m;
    double tilt_deg = 0, pushed_m = 0;
    while (simulation.Step()) {
      const Snapshot& now = simulation.snapshot();
      const Pose& X_WB = now.bodies[kObject].X_WB;
      const bool stands = std::ranges::any_of(now.contacts, [](const ContactPoint& contact) {
        return contact.a.body == BodyIndex(kTable) && contact.b.body == BodyIndex(kObject);
      });
      if (now.tick < 3 * 480 || !(stands || landed_m)) continue;
      if (!landed_m) {
        landed_m = X_WB.p_m;
        tilt_deg = std::acos(std::min((X_WB.q * Eigen::Vector3d::UnitZ()).z(), 1.0)) / kRadPerDeg;
      }
      pushed_m = std::max(pushed_m, (X_WB.p_m - *landed_m).head<2>().norm());
    }
    ASSERT_TRUE(landed_m) << mass_kg << " kg";
    EXPECT_LT(tilt_deg, 1) << mass_kg << " kg";
    EXPECT_LT(pushed_m, 0.003) << mass_kg << " kg";
  }
}

}  // namespace
}  // namespace prehend::physics
