// SPDX-License-Identifier: Apache-2.0
// The whole room end to end: scenes and scripts in, states of the world out.
#include "physics/simulation.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/physics/tabletop.h"

namespace prehend::physics {
namespace {

Script OneBeat(StepAction action, double over_s, double settle_s = 0.5) {
  return {.stages = {{{{HandIndex(0), std::move(action), over_s}}}}, .settle_s = settle_s};
}

TEST(SimulationTest, EmptySceneCompletesAfterSettling) {
  Simulation simulation({}, {.settle_s = 0.1});
  int ticks = 0;
  while (simulation.Step()) ++ticks;
  EXPECT_EQ(ticks, 48);
  EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kCompleted);
  EXPECT_EQ(simulation.status().tick, 48);
  EXPECT_FALSE(simulation.Step());
}

TEST(SimulationTest, AFreeBodyFallsAsGalileoSays) {
  Scene scene;
  scene.bodies.push_back(
      {.name = "ball", .shapes = {{Sphere{0.05}, {}}}, .mass_kg = 1, .X_WB = {{0, 0, 10}}});
  Simulation simulation(scene, {.settle_s = 1});
  while (simulation.Step()) {
  }
  EXPECT_NEAR(simulation.snapshot().bodies[0].X_WB.p_m.z(), 10 - 9.81 / 2, 0.02);
}

TEST(SimulationTest, CartonIsCarriedHalfAMetreAndStands) {
  for (const Approach approach : {Approach::kAuto, Approach::kAbove, Approach::kSide}) {
    const Outcome outcome = Perform({}, {.approach = approach});
    EXPECT_TRUE(outcome.Placed()) << outcome;
    EXPECT_LT(outcome.pushed_m, 0.001) << outcome;
  }
}

TEST(SimulationTest, EightKilogramsAreTooHeavyForFriction) {
  const Outcome outcome = Perform({.mass_kg = 8}, {});
  EXPECT_EQ(outcome.status.kind, RunStatus::Kind::kCompleted) << outcome;
  EXPECT_LT(outcome.rise_m, 0.02) << outcome;
}

struct StyleCase {
  const char* name;
  Tabletop tabletop;
  PickAndPlace task;
};

class StyleTest : public testing::TestWithParam<StyleCase> {};

TEST_P(StyleTest, Places) {
  const StyleCase& c = GetParam();
  const Outcome outcome = Perform(c.tabletop, c.task);
  EXPECT_TRUE(outcome.Placed(std::holds_alternative<Sphere>(c.tabletop.shape))) << outcome;
}

INSTANTIATE_TEST_SUITE_P(
    All, StyleTest,
    testing::Values(
        StyleCase{"pinch_box", {.shape = Box{{0.05, 0.05, 0.08}}, .mass_kg = 0.2}, {"pinch"}},
        StyleCase{"tripod_ball", {.shape = Sphere{0.035}, .mass_kg = 0.2}, {"tripod"}},
        StyleCase{"lateral_slab", {.shape = Box{{0.08, 0.012, 0.12}}, .mass_kg = 0.2}, {"lateral"}},
        StyleCase{"wrap_can", {.shape = Cylinder{0.033, 0.12}}, {"wrap"}},
        StyleCase{"wrap_turned_box", {.shape = Box{{0.06, 0.06, 0.06}}, .yaw_rad = 0.5}, {"wrap"}},
        StyleCase{"left_hand", {.hand_at_m = {-0.2, 0.2, 1.05}, .hand = "human_left"}, {"wrap"}}),
    [](const auto& instance) { return instance.param.name; });

TEST(SimulationTest, WrapSucceedsForNineteenOfTwentyVariations) {
  std::mt19937_64 generator(1);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(generator() >> 11) * 0x1p-53;
  };
  int placed = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const Outcome outcome =
        Perform({.shape = Box{{between(0.05, 0.075), between(0.05, 0.075), between(0.06, 0.2)}},
                 .mass_kg = between(0.2, 0.5),
                 .friction = between(0.7, 0.9),
                 .at_m = {between(0, 0.3), between(0, 0.2)},
                 .yaw_rad = between(-3, 3),
                 .hand_at_m = {between(-0.4, -0.1), between(-0.3, -0.1), between(1, 1.2)}},
                {});
    placed += outcome.Placed();
    if (!outcome.Placed()) std::cout << "trial " << trial << ": " << outcome << "\n";
  }
  EXPECT_GE(placed, 19);
}

TEST(SimulationTest, AHeldObjectSlidesAlongTheTable) {
  Script script = MakeScript({});
  script.stages.resize(2);
  script.stages.push_back({{{HandIndex(0), MoveStep{{0, -0.25, 0}}, 1.0}}});
  Simulation simulation(MakeScene({}), script);
  int on_table = 0, moving = 0;
  while (simulation.Step()) {
    const Snapshot& now = simulation.snapshot();
    if (now.bodies[kObject].v_WB_m_per_s.head<2>().norm() < 0.1) continue;
    ++moving;
    for (const ContactPoint& contact : now.contacts) {
      if (contact.a.body != BodyIndex(kTable) || contact.b.body != BodyIndex(kObject)) continue;
      ++on_table;
      break;
    }
  }
  EXPECT_NEAR(simulation.snapshot().bodies[kObject].X_WB.p_m.y(), -0.15, 0.03);
  EXPECT_GT(moving, 200);
  EXPECT_GT(on_table, moving * 0.9);
}

TEST(SimulationTest, AnObjectTouchesItsSupportBeforeTheHandOpens) {
  for (const Approach approach : {Approach::kAbove, Approach::kSide}) {
    Simulation simulation(MakeScene({}), MakeScript({.approach = approach}));
    bool stood = false;
    while (simulation.snapshot().hands.empty() || simulation.snapshot().tick < 3.6 * 480) {
      ASSERT_TRUE(simulation.Step());
      stood = false;
      for (const auto& points : simulation.snapshot().AllContacts())
        for (const ContactPoint& contact : points)
          stood |= contact.a.body == BodyIndex(kTable) && contact.b.body == BodyIndex(kObject);
    }
    EXPECT_TRUE(stood);
    EXPECT_EQ(simulation.snapshot().hands[0].trigger, 1);
  }
}

TEST(SimulationTest, GraspsAreFeltByFingersAndThumb) {
  Script script = MakeScript({});
  script.stages.resize(3);
  Simulation simulation(MakeScene({}), script);
  while (simulation.Step()) {
  }
  std::set<int> sets;
  for (const ContactPoint& contact : simulation.snapshot().contacts) {
    if (contact.a.body != BodyIndex(kObject) && contact.b.body != BodyIndex(kObject)) continue;
    const ContactSide& hand = contact.a.hand != kNone ? contact.a : contact.b;
    const HandModel& model = simulation.scene().hands[0].model;
    if (hand.hand != kNone)
      sets.insert(hand.link == kNone ? model.palm_sensor_set : model.link(hand.link).sensor_set);
  }
  EXPECT_GE(sets.size(), 2u);
}

TEST(SimulationTest, ASecondReachFindsAnObjectThatWasMoved) {
  Script script = MakeScript({});
  Script again = MakeScript({.to_m = {0, 0}});
  script.stages.insert(script.stages.end(), again.stages.begin(), again.stages.end());
  Simulation simulation(MakeScene({}), script);
  while (simulation.Step()) {
  }
  const Eigen::Vector3d p = simulation.snapshot().bodies[kObject].X_WB.p_m;
  EXPECT_LT(p.head<2>().norm(), 0.05);
  EXPECT_NEAR(p.z(), kTop_m + 0.1, 0.005);
}

TEST(SimulationTest, AWaitUntilTheObjectSleepsChangesNothing) {
  Script script = MakeScript({});
  script.stages.insert(script.stages.begin(), ScriptStage{{{HandIndex(0), WaitStep{}, 3}}});
  Simulation simulation(MakeScene({}), script);
  bool slept = false;
  double highest = 0;
  while (simulation.Step()) {
    slept |= simulation.snapshot().bodies[kObject].asleep;
    highest = std::max(highest, simulation.snapshot().bodies[kObject].X_WB.p_m.z());
  }
  EXPECT_TRUE(slept);
  EXPECT_GT(highest, kTop_m + 0.3);
}

TEST(SimulationTest, TheSameRunTwiceIsTheSameBitForBit) {
  const std::uint64_t alone = Perform({}, {}).hash;
  EXPECT_EQ(Perform({}, {}).hash, alone);
  EXPECT_NE(Perform({.mass_kg = 0.4001}, {}).hash, alone);

  Simulation simulation(MakeScene({}), MakeScript({}));
  Simulation other(MakeScene({.shape = Sphere{0.03}}), MakeScript({.style = "tripod"}));
  while (simulation.Step()) other.Step();
  EXPECT_EQ(simulation.state_hash(), alone);
}

TEST(SimulationTest, AnUnknownObjectEndsTheRunAsAValue) {
  Simulation simulation(MakeScene({}), OneBeat(ReachStep{"nothing"}, 0.5));
  EXPECT_FALSE(simulation.Step());
  EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kFailed);
  EXPECT_EQ(simulation.status().entity, "hand");
  EXPECT_NE(simulation.status().reason.find("'nothing'"), std::string::npos);
}

TEST(SimulationTest, ABodyThatFallsForEverEndsTheRun) {
  Scene scene;
  scene.bodies.push_back({.name = "ball", .shapes = {{Sphere{0.05}, {}}}, .mass_kg = 1});
  Simulation simulation(scene, {.settle_s = 60});
  while (simulation.Step()) {
  }
  EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kFailed);
  EXPECT_EQ(simulation.status().entity, "ball");
  EXPECT_LT(simulation.status().tick, 480 * 3);
  EXPECT_FALSE(simulation.status().advice.empty());
}

TEST(SimulationTest, AScriptOfAnHourIsRefused) {
  Simulation simulation({}, {.settle_s = 3600});
  EXPECT_FALSE(simulation.Step());
  EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kFailed);
}

}  // namespace
}  // namespace prehend::physics
