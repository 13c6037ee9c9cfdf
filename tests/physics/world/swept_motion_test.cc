// SPDX-License-Identifier: Apache-2.0
// What moves farther in a tick than it and the other one are thick does not go through.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "physics/base/random.h"
#include "physics/scene/run_limits.h"
#include "physics/simulation.h"

namespace prehend::physics {
namespace {

constexpr double kBoard_m = 1.0;  ///< height of its upper face

/// A board above a floor, both fixed.
Scene Board(double thick_m, int rate_hz) {
  Scene scene;
  scene.world.rate_hz = rate_hz;
  Body floor{.name = "floor", .fixed = true};
  floor.shapes.push_back({Box{{4, 4, 0.1}}, {}});
  floor.X_WB.p_m = {0, 0, -0.05};
  Body board{.name = "board", .fixed = true};
  board.shapes.push_back({Box{{1.2, 0.8, thick_m}}, {}});
  board.X_WB.p_m = {0, 0, kBoard_m - thick_m / 2};
  scene.bodies = {floor, board};
  return scene;
}

void Add(Scene& scene, const std::string& name, const Shape& shape, double mass_kg,
         const Eigen::Vector3d& p_m, const Eigen::Vector3d& rpy_deg = Eigen::Vector3d::Zero()) {
  Body body{.name = name, .mass_kg = mass_kg};
  body.shapes.push_back({shape, {}});
  body.X_WB = {p_m, FromRollPitchYaw(rpy_deg)};
  scene.bodies.push_back(body);
}

/// The kinds of thin things: a knife, coins of both shapes, a pea, a rod.
std::vector<std::pair<std::string, Shape>> ThinThings(double thick_m) {
  return {{"knife", Box{{0.2, 0.02, thick_m}}},
          {"square_coin", Box{{0.024, 0.024, thick_m}}},
          {"coin", Cylinder{.radius_m = 0.012, .length_m = thick_m}},
          {"pea", Sphere{.radius_m = thick_m / 2}},
          {"rod", Capsule{.radius_m = thick_m / 2, .length_m = 0.1}}};
}

/// Things that fell through the board, and notes say so.
int noted = 0;

/// Drops the things onto the board; returns those that are below it at any time, and no note says
/// so.
std::vector<std::string> Fallen(double thick_m, double drop_m, int rate_hz, double board_m,
                                const Eigen::Vector3d& rpy_deg) {
  Scene scene = Board(board_m, rate_hz);
  double x_m = -0.4;
  for (const auto& [name, shape] : ThinThings(thick_m)) {
    Add(scene, name, shape, 0.01, {x_m, 0.1, kBoard_m + drop_m}, rpy_deg);
    x_m += 0.2;
  }
  Simulation simulation(scene, Script{.stages = {}, .settle_s = std::sqrt(drop_m / 4.9) + 0.1});
  std::vector<bool> is_below(scene.bodies.size());
  while (simulation.Step())
    for (std::size_t i = 2; i < scene.bodies.size(); ++i)
      if (simulation.snapshot().bodies[i].X_WB.p_m.z() < kBoard_m - board_m / 2) is_below[i] = true;
  EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kCompleted) << simulation.status().reason;
  std::vector<std::string> fallen;
  for (std::size_t i = 2; i < scene.bodies.size(); ++i) {
    const std::string& name = scene.bodies[i].name;
    const bool is_noted = std::ranges::any_of(simulation.notes(), [&](const ScriptNote& note) {
      return LimitOf(note.text).find("(" + name + ", board)") != std::string::npos;
    });
    if (is_noted) ++noted;
    if (is_below[i] && !is_noted) fallen.push_back(name);
  }
  return fallen;
}

TEST(SweptMotion, NothingFallsThroughAThinBoard) {
  noted = 0;
  for (const double thick_m : {0.0005, 0.001, 0.003, 0.006})
    for (const double drop_m : {0.3, 0.8, 1.3, 2.0})
      for (const int rate_hz : {240, 480, 960})
        EXPECT_EQ(Fallen(thick_m, drop_m, rate_hz, 0.004, Eigen::Vector3d::Zero()),
                  std::vector<std::string>())
            << 1000 * thick_m << " mm, " << drop_m << " m, " << rate_hz << " Hz";
  EXPECT_EQ(noted, 0);
}

TEST(SweptMotion, NothingThatIsTiltedFallsThrough) {
  noted = 0;
  for (const Eigen::Vector3d& rpy_deg :
       {Eigen::Vector3d(20, 0, 0), Eigen::Vector3d(0, 40, 10), Eigen::Vector3d(87, 5, 0)})
    for (const double board_m : {0.001, 0.004})
      for (const double drop_m : {0.5, 1.1, 2.0})
        EXPECT_EQ(Fallen(0.002, drop_m, 480, board_m, rpy_deg), std::vector<std::string>())
            << rpy_deg.transpose() << ", " << 1000 * board_m << " mm, " << drop_m << " m";
}

/// As many as one likes, with the label long: 1,500 drops.
TEST(SweptMotion, OfManyDropsNoneGoesThrough) {
  noted = 0;
  Random random(7);
  for (int i = 0; i < 300; ++i) {
    const double thick_m = random.Between(0.0005, 0.006), drop_m = random.Between(0.3, 2);
    const double board_m = random.Between(0.001, 0.006);
    const int rate_hz = static_cast<int>(random.Between(240, 960));
    const Eigen::Vector3d rpy_deg(random.Between(-180, 180), random.Between(-90, 90),
                                  random.Between(-180, 180));
    EXPECT_EQ(Fallen(thick_m, drop_m, rate_hz, board_m, rpy_deg), std::vector<std::string>())
        << 1000 * thick_m << " mm onto " << 1000 * board_m << " mm, " << drop_m << " m, " << rate_hz
        << " Hz, " << rpy_deg.transpose();
  }
  EXPECT_LE(noted, 30);
}

/// The board lies loose on two blocks, which are fixed.
TEST(SweptMotion, NothingFallsThroughALooseBoard) {
  for (const double drop_m : {0.5, 1.0, 1.7}) {
    Scene scene = Board(0.004, 480);
    scene.bodies[1].fixed = false;
    scene.bodies[1].mass_kg = 2;
    for (const double x_m : {-0.55, 0.55}) {
      Add(scene, "block", Box{{0.1, 0.8, 0.2}}, 0, {x_m, 0, kBoard_m - 0.104});
      scene.bodies.back().fixed = true;
    }
    Add(scene, "knife", Box{{0.2, 0.02, 0.003}}, 0.05, {0.2, 0.1, kBoard_m + drop_m});
    Add(scene, "pea", Sphere{0.003}, 0.001, {-0.2, 0, kBoard_m + drop_m});
    Simulation simulation(scene, Script{.stages = {}, .settle_s = 1});
    while (simulation.Step()) {
    }
    EXPECT_NEAR(simulation.snapshot().bodies[4].X_WB.p_m.z(), kBoard_m + 0.0015, 5e-4) << drop_m;
    EXPECT_NEAR(simulation.snapshot().bodies[5].X_WB.p_m.z(), kBoard_m + 0.003, 5e-4) << drop_m;
  }
}

TEST(SweptMotion, WhatMeetsSomethingFastBouncesAsItShould) {
  for (const double restitution : {0.0, 0.5, 0.9}) {
    Scene scene = Board(0.004, 480);
    scene.bodies[1].restitution = 1;
    Add(scene, "coin", Box{{0.024, 0.024, 0.002}}, 0.008, {0, 0, kBoard_m + 0.001 + 0.8});
    scene.bodies.back().restitution = restitution;
    Simulation simulation(scene, Script{.stages = {}, .settle_s = 0.5});
    double rebound_m_per_s = 0;
    while (simulation.Step())
      rebound_m_per_s = std::max(rebound_m_per_s, simulation.snapshot().bodies[2].v_WB_m_per_s.z());
    EXPECT_NEAR(rebound_m_per_s, restitution * std::sqrt(2 * 9.81 * 0.8), 0.06) << restitution;
  }
}

/// Grains are thin and fast, too.
TEST(SweptMotion, GrainsStayOnAThinBoard) {
  Scene scene = Board(0.001, 480);
  Body rice{.name = "rice", .mass_kg = 0.01};
  rice.grains.emplace(Grains{.radius_m = 0.002, .p_WG_m = {}});
  for (int i = 0; i < 20; ++i)
    rice.grains->p_WG_m.push_back({0.01 * (i % 5), 0.01 * (i / 5), kBoard_m + 1.5});
  scene.bodies.push_back(rice);
  Simulation simulation(scene, Script{.stages = {}, .settle_s = 0.7});
  while (simulation.Step()) {
  }
  for (const Eigen::Vector3d& grain : simulation.snapshot().grains)
    EXPECT_GT(grain.z(), kBoard_m) << grain.transpose();
}

/// What slides fast along something thin is not held back.
TEST(SweptMotion, WhatSlidesIsNotStopped) {
  Scene scene = Board(0.004, 480);
  scene.bodies[1].X_WB.q = FromRollPitchYaw({0, 80, 0});
  scene.bodies[1].X_WB.p_m = {0, 0, 1};
  scene.bodies[1].friction = 0;
  const Eigen::Quaterniond q = scene.bodies[1].X_WB.q;
  Add(scene, "coin", Box{{0.024, 0.024, 0.002}}, 0.008,
      scene.bodies[1].X_WB.p_m + q * Eigen::Vector3d(-0.5, 0, 0.003), {0, 80, 0});
  Simulation simulation(scene, Script{.stages = {}, .settle_s = 0.4});
  while (simulation.Step()) {
  }
  const double way_m = 0.5 * 9.81 * std::sin(80 * M_PI / 180) * 0.4 * 0.4;
  EXPECT_NEAR((simulation.snapshot().bodies[2].X_WB.p_m - scene.bodies[2].X_WB.p_m).norm(), way_m,
              0.01 * way_m);
}

}  // namespace
}  // namespace prehend::physics
