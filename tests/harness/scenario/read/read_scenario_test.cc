// SPDX-License-Identifier: Apache-2.0
// What a good scenario becomes: bodies, hands, script, entity_table. What is wrong with bad ones:
// tests/harness/scenario/format/scenario_errors_test.cc.
#include "harness/scenario/read/read_scenario.h"

#include <gtest/gtest.h>

#include <numbers>

#include "harness/episode/sense/episode_format.h"
#include "harness/scenario/format/scenario_fields.h"
#include "harness/scenario/format/scenario_formats.h"
#include "tests/harness/scenario_fixture.h"

namespace prehend::scenario {
namespace {

Scenario Read(const std::string& text, const std::vector<std::string>& overrides = {},
              const std::string& file = "probe.yaml") {
  auto read = ReadScenarioText(file, text, overrides, ProbeLibrary());
  EXPECT_TRUE(read) << grammar::Format(ErrorsOf(read));
  return read.value_or(Scenario{});
}

std::string ErrorsAbout(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return Brief(ErrorsOf(ReadScenarioText("probe.yaml", text, overrides, ProbeLibrary())));
}

TEST(ReadScenario, TheProbe) {
  const Scenario scenario = Read(kProbe, {}, "some/scenarios/lift/probe.yaml");
  EXPECT_EQ(scenario.name, "probe");
  EXPECT_EQ(scenario.skill, "lift");
  EXPECT_EQ(scenario.sensing.sensing_hz, 240);
  ASSERT_EQ(scenario.scene.bodies.size(), 2u);
  const physics::Body& milk = scenario.scene.bodies[1];
  EXPECT_EQ(milk.name, "milk");
  EXPECT_EQ(milk.mass_kg, 0.4);
  EXPECT_TRUE(milk.X_WB.p_m.isApprox(Eigen::Vector3d(0.2, 0.1, 0.86), 1e-12))
      << "on top of the table";
  EXPECT_TRUE(scenario.scene.bodies[0].fixed);
  ASSERT_EQ(scenario.scene.hands.size(), 1u);
  EXPECT_EQ(scenario.scene.hands[0].model.name, "human_right");
  EXPECT_EQ(scenario.scene.hands[0].X_WH.p_m, Eigen::Vector3d(-0.2, -0.2, 1.05));
  ASSERT_EQ(scenario.script.stages.size(), 2u);
  EXPECT_EQ(std::get<physics::ReachStep>(scenario.script.stages[0].steps[0].action).object, "milk");
  EXPECT_EQ(scenario.script.stages[1].steps[0].over_s, 0.6) << "the default of close_to";
  EXPECT_EQ(scenario.script.settle_s, 0.5);
  EXPECT_EQ(scenario.pictures[0].at.value, "reaching.begin");
}

TEST(ReadScenario, EveryStep) {
  const Scenario scenario = Read(ProbeWith("  - right_hand: {close_to: 1.0}\n", R"(
  - right_hand: {reach: milk, style: pinch, from: above, offset_m: [0, 0, 0.1], point_m: [0, 0.03, 0.05], over_s: 1}
  - right_hand: {close_to: 0.5, over_s: 1}
  - right_hand: {open_to: 0.25, over_s: 1}
  - right_hand: {lift_by_m: 0.1, over_s: 1}
  - right_hand: {move_by_m: [0.1, 0.2, 0.3], over_s: 1}
  - right_hand: {carry_to_m: [0.1, 0.2], over_s: 1}
  - right_hand: {place_on: table, over_s: 1}
  - right_hand: {retreat_by_m: 0.2, over_s: 1}
  - right_hand: {wait_s: 1}
  - right_hand: {poses: [{t_s: 0, at_m: [0, 0, 1]}, {t_s: 1, at_m: [0, 0, 2], rpy_deg: [0, 0, 90], trigger: 1}]}
)"));
  ASSERT_EQ(scenario.script.stages.size(), 11u);
  const auto step = [&](std::size_t i) { return scenario.script.stages[i].steps[0]; };
  for (std::size_t i = 1; i < 11; ++i) EXPECT_EQ(step(i).over_s, 1) << i;
  const auto reach = std::get<physics::ReachStep>(step(1).action);
  EXPECT_EQ(reach.style, "pinch");
  EXPECT_EQ(reach.approach, physics::Approach::kAbove);
  EXPECT_EQ(reach.offset_m.z(), 0.1);
  EXPECT_EQ(reach.point_m, Eigen::Vector3d(0, 0.03, 0.05));
  EXPECT_EQ(std::get<physics::TriggerStep>(step(2).action).trigger, 0.5);
  EXPECT_EQ(std::get<physics::TriggerStep>(step(3).action).trigger, 0.25);
  EXPECT_EQ(std::get<physics::MoveStep>(step(4).action).by_m, Eigen::Vector3d(0, 0, 0.1));
  EXPECT_EQ(std::get<physics::MoveStep>(step(5).action).by_m, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(std::get<physics::CarryStep>(step(6).action).to_m, Eigen::Vector2d(0.1, 0.2));
  EXPECT_EQ(std::get<physics::PlaceStep>(step(7).action).support, "table");
  EXPECT_TRUE(step(7).written_at.ends_with(".yaml:19:5")) << step(7).written_at;
  EXPECT_EQ(std::get<physics::RetreatStep>(step(8).action).by_m, 0.2);
  EXPECT_TRUE(std::holds_alternative<physics::WaitStep>(step(9).action));
  const auto poses = std::get<physics::PosesStep>(step(10).action).poses;
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_TRUE(
      (poses[1].X_WH.q * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  EXPECT_EQ(poses[1].trigger, 1);
  EXPECT_FALSE(poses[0].trigger);
}

TEST(ReadScenario, TwoActorsInOneBeat) {
  std::string text =
      ProbeWith("script:\n", "  left_hand: {hand: human_left, at_m: [-0.2, 0.4, 1.05]}\nscript:\n");
  text += "settle_s: 0\n";
  text.insert(text.find("  - right_hand: {close_to"),
              "  - {left_hand: {wait_s: 0.3}, right_hand: {wait_s: 0.5}}\n");
  const Scenario scenario = Read(text);
  const physics::ScriptStage& stage = scenario.script.stages[1];
  ASSERT_EQ(stage.steps.size(), 2u);
  EXPECT_EQ(stage.steps[0].hand, physics::HandIndex(1));
  EXPECT_EQ(stage.steps[1].hand, physics::HandIndex(0));
  EXPECT_EQ(scenario.script.settle_s, 0);
}

TEST(ReadScenario, ShapesStandOnTheirLowestPoint) {
  const auto height = [](const std::string& shape) {
    return Read(ProbeWith("box: {size_m: [0.07, 0.07, 0.20]}", shape))
               .scene.bodies[1]
               .X_WB.p_m.z() -
           0.76;
  };
  EXPECT_NEAR(height("sphere: {radius_m: 0.05}"), 0.05, 1e-12);
  EXPECT_NEAR(height("cylinder: {radius_m: 0.05, length_m: 0.2}"), 0.1, 1e-12);
  EXPECT_NEAR(height("capsule: {radius_m: 0.05, length_m: 0.2}"), 0.15, 1e-12);
  EXPECT_NEAR(height("cylinder: {radius_m: 0.05, length_m: 0.2}, rpy_deg: [90, 0, 0]"), 0.05,
              1e-12);
  EXPECT_NEAR(height("box: {size_m: [0.1, 0.1, 0.1]}, rpy_deg: [45, 0, 0]"),
              0.05 * std::numbers::sqrt2, 1e-12);
}

TEST(ReadScenario, WhatStandsOnASlopeOrInAHollowTouchesTheSurfaceBelowIt) {
  const auto height = [](const std::string& table) {
    const std::string level = "box: {size_m: [1.2, 0.8, 0.04]}, at_m: [0, 0, 0.74]";
    return Read(ProbeWith(level, table)).scene.bodies[1].X_WB.p_m.z() - 0.1;
  };
  // The milk is 70 mm wide, at (0.2, 0.1).
  const double slope = std::tan(15 * std::numbers::pi / 180);
  EXPECT_NEAR(height("box: {size_m: [1.2, 0.8, 0.04]}, at_m: [0, 0, 0.74], rpy_deg: [15, 0, 0]"),
              0.74 + 0.02 * std::sqrt(1 + slope * slope) + (0.1 + 0.035) * slope, 1e-6);
  EXPECT_NEAR(height("bowl: {radius_m: 0.3, height_m: 0.2}, at_m: [0.2, 0.1, 0.8]"), 0.706, 1e-6);
}

TEST(ReadScenario, StacksInAnyOrder) {
  const Scenario scenario = Read(ProbeWith("actors:",
                                           "  cup: {cylinder: {radius_m: 0.03, length_m: 0.1}, "
                                           "mass_kg: 0.1, on: tray, at_m: [-0.3, 0.2]}\n"
                                           "  tray: {box: {size_m: [0.2, 0.2, 0.02]}, mass_kg: "
                                           "0.3, on: table, at_m: [-0.3, 0.2]}\nactors:"));
  EXPECT_NEAR(scenario.scene.bodies[2].X_WB.p_m.z(), 0.76 + 0.02 + 0.05, 1e-12);
}

TEST(ReadScenario, RollPitchYawTurnsAboutWorldAxes) {
  const Scenario scenario =
      Read(ProbeWith("at_m: [-0.2, -0.2, 1.05]", "at_m: [-0.2, -0.2, 1.05], rpy_deg: [90, 0, 90]"));
  const Eigen::Quaterniond q = scenario.scene.hands[0].X_WH.q;
  // z is first rolled into -y, then yawed into x.
  EXPECT_TRUE((q * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d::UnitX(), 1e-12));
}

TEST(ReadScenario, GainsReplaceOnlyWhatIsGiven) {
  const Scenario scenario = Read(
      ProbeWith("hand: human_right", "hand: human_right, gains: {translation: {limit_n: 40}}"));
  EXPECT_EQ(scenario.scene.hands[0].model.translation.limit, 40);
  EXPECT_EQ(scenario.scene.hands[0].model.translation.proportional, 2500);
}

TEST(ReadScenario, OverridesComeBeforeTheChecks) {
  EXPECT_EQ(Read(kProbe, {"entities.milk.mass_kg=8"}).scene.bodies[1].mass_kg, 8);
  EXPECT_EQ(Read(kProbe, {"world={rate_hz: 960, sensing_hz: 30}"}).scene.world.rate_hz, 960);
  EXPECT_EQ(ErrorsAbout(kProbe, {"entities.milk.mass_kg=-8"}),
            "--set:1:23: mass_kg: expected a number from 0.001 to 1000, found '-8'\n");
  EXPECT_EQ(ErrorsAbout(kProbe, {"entities.milk.on=tables"}),
            "--set:1:18: on: no entity is called 'tables' | did you mean 'table'?\n");
}

TEST(ReadScenario, LimitsOnTheWhole) {
  std::string stages;
  for (int i = 0; i < 7; ++i) stages += "  - right_hand: {wait_s: 600}\n";
  EXPECT_EQ(ErrorsAbout(ProbeWith("pictures:\n", stages + "pictures:\n")),
            "15:5: the script and settle_s are longer than 1800 s at this point\n");

  std::string many;
  for (std::size_t i = 0; i <= kMaxBeats; ++i) many += "  - right_hand: {wait_s: 0.01}\n";
  EXPECT_EQ(ErrorsAbout(ProbeWith("pictures:\n", many + "pictures:\n")),
            "11:3: script: expected at most 1000 items, found 1003\n");
}

TEST(ReadScenario, TenThousandEntitiesAreReadAndCheckedQuickly) {
  std::string entities;
  for (std::size_t i = 0; i < kMaxEntities - 2; ++i) {
    entities += "  e" + std::to_string(i) + ": {fixed: true, sphere: {radius_m: 0.05}, at_m: [" +
                std::to_string(0.12 * static_cast<double>(i % 100)) + ", " +
                std::to_string(0.12 * static_cast<double>(i / 100)) + ", 5]}\n";
  }
  EXPECT_EQ(Read(ProbeWith("actors:\n", entities + "actors:\n")).scene.bodies.size(), kMaxEntities);
  entities += "  one_too_many: {fixed: true, sphere: {radius_m: 0.1}, at_m: [0, 0, 9]}\n";
  EXPECT_EQ(ErrorsAbout(ProbeWith("actors:\n", entities + "actors:\n")),
            "6:3: entities: expected at most 10000 keys, found 10001\n");
}

TEST(MakeEntityTable, BodiesFirstThenHands) {
  const grammar::EntityTable entity_table = episode::MakeEntityTable(Read(kProbe));
  EXPECT_EQ(entity_table.ticks_per_second, 480);
  ASSERT_EQ(entity_table.entities.size(), 3u);
  EXPECT_EQ(entity_table.entities[0].classes,
            (std::vector<std::string>{"Table", "Fixed", "Thing", "Entity"}));
  EXPECT_EQ(entity_table.entities[1].classes,
            (std::vector<std::string>{"Object", "Movable", "Thing", "Entity"}));
  EXPECT_TRUE(entity_table.entities[1].half_size_m.isApprox(Eigen::Vector3d(0.035, 0.035, 0.1)));
  EXPECT_EQ(entity_table.entities[2].name, "right_hand");
  EXPECT_EQ(entity_table.entities[2].classes, (std::vector<std::string>{"Hand", "Entity"}));
  EXPECT_EQ(entity_table.styles, (std::vector<std::string>{"wrap", "pinch"}));
}

TEST(MakeEntityTable, HasTrueShapes) {
  const grammar::EntityTable entity_table = episode::MakeEntityTable(Read(
      ProbeWith("actors:\n",
                "  can: {fixed: true, cylinder: {radius_m: 0.03, length_m: 0.1}, at_m: [0, 0, 3]}\n"
                "  wedge: {fixed: true, hull: {points_m: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, "
                "1]]}, at_m: [0, 0, 5]}\n"
                "  pair: {fixed: true, at_m: [3, 0, 3], parts: [{box: {size_m: [0.1, 0.1, 0.1]}, "
                "at_m: [0, 0, 0], rpy_deg: [0, 0, 45]},\n"
                "    {capsule: {radius_m: 0.01, length_m: 0.1}, at_m: [0.5, 0, 0]}, {sphere: "
                "{radius_m: 0.1}, at_m: [0, 1, 0]}]}\n"
                "actors:\n")));
  const auto solid = [&](std::size_t i) -> const grammar::Solid& {
    return entity_table.entities[i].solid;
  };
  EXPECT_TRUE(solid(1).IsEmpty()) << "the box of the probe is its bounding box";
  EXPECT_NEAR(solid(2).DistanceTo({0.06, 0.08, 0.05}), 0.07, 1e-9);
  EXPECT_NEAR(solid(3).DistanceTo({1, 1, 1}), 2 / std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(solid(4).DistanceTo({0.15, 0, 0}), 0.15 - 0.05 * std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(solid(4).DistanceTo({0.5, 0, 0.1}), 0.04, 1e-9);
  EXPECT_NEAR(solid(4).DistanceTo({0, 1.2, 0}), 0.1, 1e-9);
}

}  // namespace
}  // namespace prehend::scenario
