// SPDX-License-Identifier: Apache-2.0
// Stages in which a hand has several steps, or steps wait for others: the part of
// physics/hand/script_player.h that physics/motion/stage_clock.h is for.
#include <gtest/gtest.h>

#include <array>

#include "physics/hand/script_player.h"
#include "physics/person/skeleton.h"
#include "tests/physics/tabletop.h"

namespace prehend::physics {
namespace {

using Eigen::Vector3d;

/// The tabletop with a second hand.
Scene TwoHands() {
  Scene scene = MakeScene({});
  scene.hands.push_back({"other", LibraryHand("human_left"), {{-0.2, 0.3, 1.05}}});
  return scene;
}

Step Named(std::size_t hand, StepAction action, double over_s, StepOrder order) {
  Step step{HandIndex(hand), std::move(action), over_s};
  step.order = std::move(order);
  return step;
}

/// By tick how far the targets of the hands are from where they began.
std::vector<std::array<double, 2>> WaysOf(const Scene& scene, Script script) {
  Simulation still(scene, {});
  ScriptPlayer player(scene, std::move(script));
  std::vector<std::array<double, 2>> ways;
  while (const auto* commands = player.Advance(still.snapshot())) {
    std::array<double, 2>& way = ways.emplace_back();
    for (std::size_t h = 0; h < 2; ++h)
      way[h] = ((*commands)[h].target.X_WH.p_m - scene.hands[h].X_WH.p_m).norm();
  }
  EXPECT_EQ(player.problem(), "");
  return ways;
}

TEST(OrderedStage, StepsInARowAreAsThoseOfSeveralStages) {
  const Scene scene = MakeScene({});
  const Script reference = MakeScript({});
  ScriptStage row;
  for (const ScriptStage& stage : reference.stages) row.steps.push_back(stage.steps.front());
  const auto hash_of = [&](Script script) {
    Simulation simulation(scene, std::move(script));
    while (simulation.Step()) {
    }
    EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kCompleted) << simulation.status().reason;
    return simulation.state_hash();
  };
  EXPECT_EQ(hash_of({.stages = {row}, .settle_s = reference.settle_s}), hash_of(reference));
}

TEST(OrderedStage, OneHandWaitsForTheOther) {
  const Scene scene = TwoHands();
  const MoveStep up{{0, 0, 0.1}};
  const auto ways =
      WaysOf(scene, {.stages = {{{Named(0, up, 0.5, {}), Named(0, up, 0.5, {.name = "second"}),
                                  Named(1, up, 0.25, {.with = "second"}),
                                  Named(1, up, 0.25, {.after = "second"})}}},
                     .settle_s = 0});
  ASSERT_EQ(ways.size(), 600u) << "1.25 s at 480 Hz";
  EXPECT_NEAR(ways[239][0], 0.1, 1e-9);
  EXPECT_EQ(ways[239][1], 0) << "it rests";
  EXPECT_NEAR(ways[299][1], 0.05, 1e-9) << "in the middle of its first step";
  EXPECT_NEAR(ways[359][1], 0.1, 1e-9);
  EXPECT_NEAR(ways[479][1], 0.1, 1e-9) << "it waits";
  EXPECT_NEAR(ways[479][0], 0.2, 1e-9);
  EXPECT_NEAR(ways.back()[1], 0.2, 1e-9);
}

TEST(OrderedStage, AGuardedStepEndsEarlyAndTheNextBegins) {
  Scene scene = TwoHands();
  Step down{HandIndex(0), MoveStep{{0, 0, -0.5}}, 5};
  down.until = Until{.thing = "table", .gap_m = 0.05};
  down.order.name = "down";
  const Script script{.stages = {{{down, Step{HandIndex(0), MoveStep{{0, 0, 0.1}}, 0.5},
                                   Named(1, MoveStep{{0.1, 0, 0}}, 0.5, {.after = "down"})}}},
                      .settle_s = 0};
  Simulation simulation(scene, script);
  while (simulation.Step()) {
  }
  EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kCompleted) << simulation.status().reason;
  const double time_s = static_cast<double>(simulation.snapshot().tick) / scene.world.rate_hz;
  EXPECT_LT(time_s, 4);
  EXPECT_GT(time_s, 1);
  EXPECT_NEAR(simulation.snapshot().hands[1].palm.X_WB.p_m.x(), -0.1, 0.02);
}

TEST(OrderedStage, AGuardThatFailsEndsTheRunAtItsOwnEnd) {
  const Scene scene = TwoHands();
  Step aside{HandIndex(0), MoveStep{{0, -0.05, 0}}, 0.5};
  aside.until = Until{.thing = "table"};
  Simulation simulation(scene, {.stages = {{{aside, Step{HandIndex(0), WaitStep{}, 5}}}}});
  while (simulation.Step()) {
  }
  EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kFailed);
  EXPECT_EQ(simulation.snapshot().tick, 240);
  EXPECT_NE(simulation.status().reason.find("has not touched 'table'"), std::string::npos)
      << simulation.status().reason;
}

TEST(OrderedStage, ThePersonWaitsAndWalks) {
  Scene scene = MakeScene({});
  Person person{.name = "anna", .head = BodyIndex(scene.bodies.size())};
  person.X_WS = {{-0.9, 0, 0}};
  for (Body& part : PartsOf(person)) scene.bodies.push_back(part);
  scene.persons.push_back(person);
  PersonStep turn{0, TurnStep{0.5}, 0.2}, lean{0, LeanStep{0.2}, 0.2};
  turn.order.after = "moved";
  lean.delay_s = 0.1;
  const Script script{
      .stages = {{.steps = {Named(0, MoveStep{{0, 0, 0.1}}, 0.5, {.name = "moved"})},
                  .person_steps = {turn, lean}}},
      .settle_s = 0};
  const Simulation still(scene, {});
  ScriptPlayer player(scene, script);
  std::vector<std::int64_t> begun;
  std::int64_t tick = 0;
  for (; player.Advance(still.snapshot()); ++tick)
    for (const BegunSteps& steps : player.begun())
      begun.insert(begun.end(), steps.person_steps.size(), tick);
  EXPECT_EQ(begun, (std::vector<std::int64_t>{240, 384})) << "0.5 s; 0.2 s and its delay later";
  EXPECT_EQ(tick, 480);
}

TEST(OrderedStage, StepsThatWaitForEachOtherFail) {
  const Scene scene = MakeScene({});
  Simulation simulation(
      scene, {.stages = {{{Named(0, WaitStep{}, 0.5, {.name = "own", .after = "own"})}}}});
  EXPECT_FALSE(simulation.Step());
  EXPECT_EQ(simulation.status().reason, "the steps of a stage wait for each other");
}

}  // namespace
}  // namespace prehend::physics
