// SPDX-License-Identifier: Apache-2.0
// Grains in Bullet: they come to rest in their vessel, and are seen as one body.
#include <gtest/gtest.h>

#include "physics/scene/compounds.h"
#include "physics/scene/fill_vessel.h"
#include "physics/scene/geometry.h"
#include "physics/simulation.h"

namespace prehend::physics {
namespace {

constexpr int kCount = 30;

/// A fixed mug with its centre at the origin, and peas in it.
Scene FilledMug() {
  Scene scene;
  scene.bodies.push_back({.name = "mug", .shapes = ShapesOf(Mug{}), .fixed = true});
  Body peas{.name = "peas",
            .shapes = {},
            .grains = Grains{.radius_m = 0.006, .p_WG_m = {}},
            .mass_kg = 0.03};
  peas.grains->p_WG_m = FillVessel(scene.bodies[0], 0.006, kCount, 1);
  scene.bodies.push_back(peas);
  return scene;
}

Snapshot After(const Scene& scene, double settle_s, std::uint64_t* hash = nullptr) {
  Simulation simulation(scene, Script{.stages = {}, .settle_s = settle_s});
  while (simulation.Step()) {
  }
  EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kCompleted) << simulation.status().reason;
  if (hash) *hash = simulation.state_hash();
  return simulation.snapshot();
}

TEST(Grains, StayInTheirVessel) {
  const Scene scene = FilledMug();
  const Snapshot end = After(scene, 0.5);
  ASSERT_EQ(end.grains.size(), static_cast<std::size_t>(kCount));
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& grain : end.grains) {
    EXPECT_TRUE(IsInside(scene.bodies[0], Pose{}, grain)) << grain.transpose();
    EXPECT_GT(grain.z(), -0.05 + 0.005 + 0.006 - 0.001);
    mean += grain / kCount;
  }
  EXPECT_LT((end.bodies[1].X_WB.p_m - mean).norm(), 1e-12);
  EXPECT_LT(end.bodies[1].v_WB_m_per_s.norm(), 0.02);
}

TEST(Grains, TouchAsOne) {
  const Snapshot end = After(FilledMug(), 0.2);
  ASSERT_FALSE(end.contacts.empty());
  for (const ContactPoint& contact : end.contacts) {
    EXPECT_EQ(contact.a.body, BodyIndex(0));
    EXPECT_EQ(contact.b.body, BodyIndex(1));
  }
}

TEST(Grains, AreNoThing) {
  const Scene scene = FilledMug();
  EXPECT_FALSE(IsThing(scene.bodies[1]));
  EXPECT_FALSE(MovesFreely(scene, BodyIndex(1)));
}

TEST(Grains, MoveTheSameEveryTime) {
  std::uint64_t first = 0, second = 0;
  After(FilledMug(), 0.1, &first);
  After(FilledMug(), 0.1, &second);
  EXPECT_EQ(first, second);
}

TEST(Grains, WhatIsSpiltStopsFarAway) {
  Scene scene = FilledMug();
  scene.bodies[0].X_WB.p_m = {1, 0, 0};  // they fall past it
  const Snapshot end = After(scene, 3);
  for (const Eigen::Vector3d& grain : end.grains) EXPECT_LT(grain.norm(), 10.1);
}

TEST(Grains, AreWhereTheyWerePlacedBeforeTheFirstTick) {
  const Scene scene = FilledMug();
  EXPECT_EQ(GrainsOf(scene, BodyIndex(1), Snapshot{})[3], scene.bodies[1].grains->p_WG_m[3]);
}

}  // namespace
}  // namespace prehend::physics
