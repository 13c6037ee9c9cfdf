// SPDX-License-Identifier: Apache-2.0
// What bounces, against free flight: physics/bullet/core/flat_impacts.h,
// physics/bullet/core/flat_impacts.h, physics/world/contact_hold.h.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "physics/box2d/world.h"
#include "physics/bullet/world.h"
#include "physics/scene/compounds.h"
#include "physics/scene/hull.h"

namespace prehend::physics {
namespace {

constexpr double kGravity = 9.81;
constexpr double kTick_s = 1.0 / 480;

struct Drop {
  double radius_m, height_m, restitution;
};

Scene MakeScene(const Drop& drop, Engine engine) {
  const Body floor{.name = "floor",
                   .shapes = {{Box{{2, 2, 0.1}}, {}}},
                   .fixed = true,
                   .restitution = 1,
                   .X_WB = {{0, 0, -0.05}}};
  const Body ball{.name = "ball",
                  .shapes = {{Sphere{drop.radius_m}, {}}},
                  .mass_kg = 0.2,
                  .restitution = drop.restitution,
                  .X_WB = {{0, 0, drop.radius_m + drop.height_m}}};
  Scene scene{.bodies = {floor, ball}};
  scene.world.planar = engine == Engine::kBox2d;
  return scene;
}

std::unique_ptr<World> MakeWorld(const Scene& scene) {
  return scene.world.planar ? MakeBox2dWorld(scene, {}) : MakeBulletWorld(scene, {});
}

/// Seconds at which the ball meets the floor before `until_s`.
std::vector<double> ContactTimes(const Scene& scene, double until_s) {
  const auto world = MakeWorld(scene);
  std::vector<double> times_s;
  Snapshot snapshot;
  bool touched = false;
  while (snapshot.tick < until_s * scene.world.rate_hz) {
    world->Step({});
    world->Describe(snapshot);
    const bool touches = !snapshot.contacts.empty();
    if (touches && !touched)
      times_s.push_back(static_cast<double>(snapshot.tick) / scene.world.rate_hz);
    touched = touches;
  }
  return times_s;
}

/// How often it meets the floor in free flight as long as flights last 0.1 s.
std::size_t CountBounces(const Drop& drop, double fall_s) {
  std::size_t count = 1;
  for (double flight_s = 2 * fall_s * drop.restitution; flight_s > 0.1; ++count)
    flight_s *= drop.restitution;
  return count;
}

class BounceTest : public testing::TestWithParam<Engine> {};

INSTANTIATE_TEST_SUITE_P(Worlds, BounceTest, testing::Values(Engine::kBullet, Engine::kBox2d),
                         [](const auto& engine) {
                           return engine.param == Engine::kBox2d ? "box2d" : "bullet";
                         });

TEST_P(BounceTest, EveryBounceIsAContactAtItsTime) {
  // From 1.4 to 4 m/s: 3 to 8 mm a tick, far more than a contact is deep.
  for (const double radius_m : {0.03, 0.2})
    for (const double height_m : {0.1, 0.21, 0.4, 0.8})
      for (const double restitution : {0.5, 0.81}) {
        const Drop drop{radius_m, height_m, restitution};
        SCOPED_TRACE(testing::Message() << radius_m << ' ' << height_m << ' ' << restitution);
        const std::vector<double> times_s = ContactTimes(MakeScene(drop, GetParam()), 4);
        const double fall_s = std::sqrt(2 * height_m / kGravity);
        const std::size_t count = CountBounces(drop, fall_s);
        ASSERT_GE(times_s.size(), count);
        EXPECT_NEAR(times_s[0], fall_s, 2 * kTick_s);
        double flight_s = 2 * fall_s;
        for (std::size_t i = 1; i < count; ++i) {
          const double before_s = std::exchange(flight_s, times_s[i] - times_s[i - 1]);
          EXPECT_NEAR(flight_s, restitution * before_s, 4 * kTick_s) << "flight " << i;
        }
      }
}

TEST(Bounce, HasNoMoreEnergyAtMoreTicksPerSecond) {
  for (const int rate_hz : {480, 960, 1920, 4800})
    for (const double restitution : {0.0, 0.5, 1.0}) {
      SCOPED_TRACE(testing::Message() << rate_hz << " Hz, restitution " << restitution);
      Scene scene = MakeScene({0.05, 0.25, restitution}, Engine::kBullet);
      scene.world.rate_hz = rate_hz;
      scene.bodies[1].shapes = {{Box{{0.1, 0.1, 0.1}}, {}}};
      const auto world = MakeWorld(scene);
      Snapshot snapshot;
      double least_m = 1, apex_m = 0;
      for (int tick = 0; tick < rate_hz * 0.6; ++tick) {
        world->Step({});
        world->Describe(snapshot);
        const double z_m = snapshot.bodies[1].X_WB.p_m.z();
        if (tick < rate_hz * 0.24) least_m = std::min(least_m, z_m);
        if (tick > rate_hz * 0.25) apex_m = std::max(apex_m, z_m);
      }
      EXPECT_NEAR(least_m, 0.05, 0.006);
      EXPECT_NEAR(apex_m - 0.05, 0.25 * restitution * restitution, 0.008);
    }
}

/// Of bodies that nothing touched in this tick, the largest change of speed that is not gravity's.
double PushFromNowhere(const Snapshot& before, const Snapshot& now) {
  std::vector<char> touched(now.bodies.size(), 0);
  for (const auto& part : now.AllContacts())
    for (const ContactPoint& point : part)
      for (const ContactSide& side : {point.a, point.b}) At(touched, side.body) = 1;
  double most_m_per_s = 0;
  for (std::size_t i = 1; i < now.bodies.size(); ++i) {  // the floor is the first
    if (touched[i]) continue;
    const Eigen::Vector3d fallen(0, 0, -kGravity * kTick_s);
    const Eigen::Vector3d change = now.bodies[i].v_WB_m_per_s - before.bodies[i].v_WB_m_per_s;
    most_m_per_s = std::max(most_m_per_s, (change - fallen).norm());
  }
  return most_m_per_s;
}

TEST_P(BounceTest, NothingIsPushedWithoutAContact) {
  Scene scene = MakeScene({0.04, 0.4, 0.8}, GetParam());
  for (int i = 0; i < 6; ++i) {
    const Eigen::AngleAxisd turn(0.3 + 0.4 * i, Eigen::Vector3d::UnitY());
    std::vector<PlacedShape> shapes;
    if (i % 2)
      shapes.push_back({Sphere{0.03}, {}});
    else
      shapes.push_back({Box{{0.05 + 0.02 * i, 0.1, 0.08}}, {}});
    scene.bodies.push_back(
        {.name = "thing",
         .shapes = shapes,
         .mass_kg = 0.1 + 0.1 * i,
         .restitution = 0.15 * i,
         .X_WB = {{0.06 * i - 0.2, 0, 0.3 + 0.2 * i}, Eigen::Quaterniond(turn)}});
  }
  const auto world = MakeWorld(scene);
  Snapshot before, now;
  world->Describe(now);
  for (int tick = 1; tick <= 2 * 480; ++tick) {
    before = now;
    world->Step({});
    world->Describe(now);
    ASSERT_LT(PushFromNowhere(before, now), 1e-5) << "tick " << tick;
  }
}

/// What falls flat, and how high its centre is when it lies there.
struct Flat {
  const char* name;
  std::vector<PlacedShape> shapes;
  double half_m;
  double most_rad_per_s = 0.1;  ///< that the fall may leave it with
};

std::vector<Flat> FlatThings(Engine engine) {
  std::vector<Flat> things = {{"can", {{Cylinder{0.033, 0.12}, {}}}, 0.06},
                              {"long box", {{Box{{0.3, 0.08, 0.08}}, {}}}, 0.04, 0.6}};
  if (engine == Engine::kBox2d) return things;
  std::vector<Eigen::Vector3d> corners_m;
  for (const double x : {-0.1, 0.1})
    for (const double y : {-0.05, 0.05})
      for (const double z : {-0.03, 0.03}) corners_m.emplace_back(x, y, z);
  const Eigen::Quaterniond lying(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX()));
  things.push_back({"hull", {{*MakeHull(corners_m).hull, {}}}, 0.03});
  things.push_back(
      {"lying can", {{Cylinder{0.033, 0.12}, {Eigen::Vector3d::Zero(), lying}}}, 0.033, 0.5});
  things.push_back({"mug", ShapesOf(Mug{.handle_m = 0}), 0.05, 0.5});
  return things;
}

TEST_P(BounceTest, WhatFallsFlatDoesNotTip) {
  for (const Flat& thing : FlatThings(GetParam()))
    for (const double restitution : {0.0, 0.5})
      for (const double height_m : {0.05, 0.44}) {
        SCOPED_TRACE(testing::Message() << thing.name << ' ' << restitution << ' ' << height_m);
        Scene scene = MakeScene({0.04, 0, restitution}, GetParam());
        scene.bodies[1].shapes = thing.shapes;
        scene.bodies[1].X_WB.p_m.z() = thing.half_m + height_m;
        const auto world = MakeWorld(scene);
        const double fall_s = std::sqrt(2 * height_m / kGravity);
        double highest_m_per_s = 0;
        Snapshot now;
        while (now.tick < 2 * fall_s / kTick_s) {
          world->Step({});
          world->Describe(now);
          ASSERT_LT(now.bodies[1].w_WB_rad_per_s.norm(), thing.most_rad_per_s) << now.tick;
          highest_m_per_s = std::max(highest_m_per_s, now.bodies[1].v_WB_m_per_s.z());
        }
        EXPECT_NEAR(highest_m_per_s, restitution * kGravity * fall_s, 0.05);
      }
}

}  // namespace
}  // namespace prehend::physics
