// SPDX-License-Identifier: Apache-2.0
#include "harness/show/pictures/scenery.h"

#include <gtest/gtest.h>

namespace prehend::show {
namespace {

struct Room {
  void Add(const char* name, const char* kind, const Eigen::Vector3d& size_m,
           const Eigen::Vector3d& at_m, bool fixed = true) {
    scenario.scene.bodies.push_back(
        {.name = name, .shapes = {{physics::Box{size_m}, {}}}, .fixed = fixed});
    scenario.body_classes.emplace_back(kind);
    now.bodies.emplace_back().X_WB.p_m = at_m;
  }
  std::vector<render::Prop> Legs() const { return LegsOf(scenario, BodyColors(scenario), now); }

  scenario::Scenario scenario;
  physics::Snapshot now;
};

TEST(SceneryTest, ColorsAreSaidOrInTheNameOrOfTheClass) {
  Room room;
  room.Add("blue_cup", "Cup", {0.1, 0.1, 0.1}, {0, 0, 1}, false);
  room.Add("milk", "MilkCarton", {0.1, 0.1, 0.1}, {0, 0, 1}, false);
  room.Add("thing", "Thing", {0.1, 0.1, 0.1}, {0, 0, 1}, false);
  const std::vector<render::Color> usual = BodyColors(room.scenario);
  EXPECT_GT(usual[0].z(), usual[0].x() + 0.2f) << "blue";
  EXPECT_GT(usual[1].minCoeff(), 0.85f) << "white";
  room.scenario.colors = {{"blue_cup", 0xFF0000}, {"thing", 0x00FF00}};
  EXPECT_EQ(BodyColors(room.scenario)[0], render::Color(1, 0, 0));
  EXPECT_EQ(BodyColors(room.scenario)[1], usual[1]);
  EXPECT_EQ(BodyColors(room.scenario)[2], render::Color(0, 1, 0));
}

TEST(SceneryTest, ABoardInTheAirHasLegsDownToTheFloor) {
  Room room;
  room.Add("table", "Table", {1.2, 0.8, 0.04}, {0, 0, 0.74});
  const std::vector<render::Prop> legs = room.Legs();
  ASSERT_EQ(legs.size(), 4u);
  for (const render::Prop& leg : legs) {
    EXPECT_EQ(leg.name, "leg:table");
    EXPECT_NEAR(leg.center_m.z() - leg.half_size_m.z(), 0, 1e-6);
    EXPECT_NEAR(leg.center_m.z() + leg.half_size_m.z(), 0.72, 1e-6);
    EXPECT_LT(std::abs(leg.center_m.x()), 0.6);
  }
}

TEST(SceneryTest, WhatStandsOnSomethingHasNoLegs) {
  Room room;
  room.Add("floor", "Floor", {3, 3, 0.04}, {0, 0, 0.0});
  room.Add("post", "Post", {0.1, 0.1, 0.5}, {1, 1, 0.25});
  room.Add("tray", "Tray", {0.4, 0.4, 0.02}, {5, 5, 0.8}, false);
  EXPECT_TRUE(room.Legs().empty());
  room.Add("table", "Table", {0.8, 0.8, 0.04}, {9, 0, 0.74});
  EXPECT_EQ(room.Legs().size(), 4u);
  room.Add("rail", "Rail", {0.1, 0.4, 0.02}, {9.45, 0, 0.9});
  room.Add("wall", "Wall", {0.02, 0.4, 1.0}, {9.52, 0, 0.5});
  EXPECT_EQ(room.Legs().size(), 4u) << "the wall bears the rail";
  room.Add("cabinet", "Cabinet", {0.6, 0.6, 0.7}, {9, 0, 0.35});
  EXPECT_TRUE(room.Legs().empty()) << "the cabinet carries it";
}

TEST(SceneryTest, ThingsOfAllSizesStandOnSomething) {
  Room room;
  room.Add("cupboard", "Cupboard", {0.4, 0.5, 0.6}, {0, 0, 0.9});
  ASSERT_EQ(room.Legs().size(), 4u);
  EXPECT_NEAR(room.Legs()[0].center_m.z() + room.Legs()[0].half_size_m.z(), 0.6, 1e-6);
  room = {};
  room.Add("beam", "Beam", {0.6, 0.05, 0.05}, {0, 0, 1.6});
  ASSERT_EQ(room.Legs().size(), 2u) << "at its ends";
  EXPECT_NEAR(std::abs(room.Legs()[0].center_m.x()), 0.26, 1e-6);
  room = {};
  room.Add("peg", "Peg", {0.02, 0.1, 0.1}, {0, 0, 1});
  ASSERT_EQ(room.Legs().size(), 1u);
  EXPECT_NEAR(room.Legs()[0].half_size_m.x(), 0.01, 1e-6) << "no wider than it";
  room = {};
  room.Add("low", "Cabinet", {0.4, 0.5, 0.6}, {0, 0, 0.35});
  ASSERT_EQ(room.Legs().size(), 1u) << "a plinth";
  EXPECT_NEAR(room.Legs()[0].half_size_m.y(), 0.23, 1e-6);
  EXPECT_NEAR(room.Legs()[0].center_m.z() + room.Legs()[0].half_size_m.z(), 0.05, 1e-6);
}

TEST(SceneryTest, ALegEndsOnWhatIsBelowIt) {
  Room room;
  room.Add("step", "Step", {1, 1, 0.3}, {0.6, 0, 0.15});
  room.Add("table", "Table", {1, 0.6, 0.04}, {0, 0, 0.74});
  for (const render::Prop& leg : room.Legs()) {
    const float foot_m = leg.center_m.z() - leg.half_size_m.z();
    EXPECT_NEAR(foot_m, leg.center_m.x() > 0.1f ? 0.3 : 0, 1e-6);
  }
  EXPECT_EQ(room.Legs().size(), 4u);
}

TEST(SceneryTest, APersonIsPaleOnlyWhereSheHidesAHand) {
  Room room;
  room.Add("anna", "Person", {0.3, 0.3, 0.3}, {0, 0, 1});
  room.scenario.scene.bodies[0].fixed = false;
  room.scenario.scene.bodies[0].kinematic = true;
  room.now.hands.emplace_back().palm.X_WB.p_m = {0, 1, 1};
  EXPECT_LT(BodyAlphas(room.scenario.scene, room.now, {0, -2, 1})[0], 0.5f) << "between";
  EXPECT_EQ(BodyAlphas(room.scenario.scene, room.now, {2, 1, 1})[0], 1) << "beside";
  EXPECT_EQ(BodyAlphas(room.scenario.scene, room.now, {0, 3, 1})[0], 1) << "behind";
}

TEST(SceneryTest, APersonIsPaleWhereSheHidesWhatMovesOrIsTouched) {
  Room room;
  room.Add("anna", "Person", {0.3, 0.3, 0.3}, {0, 0, 1});
  room.scenario.scene.bodies[0].fixed = false;
  room.scenario.scene.bodies[0].kinematic = true;
  room.Add("drawer", "Drawer", {0.3, 0.3, 0.1}, {0, 1, 1}, false);
  const auto alpha = [&] { return BodyAlphas(room.scenario.scene, room.now, {0, -2, 1})[0]; };
  EXPECT_EQ(alpha(), 1) << "a thing at rest";
  room.now.bodies[1].v_WB_m_per_s = {0, 0.1, 0};
  EXPECT_LT(alpha(), 0.5f) << "moves";
  room.now.bodies[1].v_WB_m_per_s.setZero();
  room.now.contacts = {
      {.a = {.body = physics::BodyIndex(0)}, .b = {.body = physics::BodyIndex(1)}}};
  EXPECT_LT(alpha(), 0.5f) << "touched";
}

TEST(SceneryTest, AGazeEndsAtWhatIsSeen) {
  Room room;
  room.scenario.scene.persons.push_back({.name = "anna"});
  room.now.gazes.push_back({.p_WE_m = {0, 0, 1},
                            .toward_W = {0, 1, 0},
                            .body = physics::BodyIndex(0),
                            .distance_m = 0.7});
  auto rays = GazesOf(room.scenario.scene, room.now);
  ASSERT_EQ(rays.size(), 1u);
  EXPECT_TRUE(rays[0].hits);
  EXPECT_LT((rays[0].to_m - Eigen::Vector3f(0, 0.7f, 1)).norm(), 1e-6f);
  room.now.gazes[0].body = physics::kNone;
  rays = GazesOf(room.scenario.scene, room.now);
  EXPECT_FALSE(rays[0].hits);
}

}  // namespace
}  // namespace prehend::show
