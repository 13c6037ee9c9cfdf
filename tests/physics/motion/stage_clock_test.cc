// SPDX-License-Identifier: Apache-2.0
#include "physics/motion/stage_clock.h"

#include <gtest/gtest.h>

namespace prehend::physics {
namespace {

Step Waiting(int hand, double over_s, StepOrder order = {}, double delay_s = 0) {
  Step step{HandIndex(hand), WaitStep{}, over_s};
  step.order = std::move(order);
  step.delay_s = delay_s;
  return step;
}

PersonStep Walking(double over_s, StepOrder order = {}, double delay_s = 0) {
  PersonStep step{0, WalkStep{}, over_s};
  step.order = std::move(order);
  step.delay_s = delay_s;
  return step;
}

using Steps = std::vector<std::size_t>;

TEST(StageClock, APlainStageLastsAsLongAsItsLongestStep) {
  const ScriptStage stage{.steps = {Waiting(0, 0.5), Waiting(1, 0.25, {}, 0.5)},
                          .person_steps = {Walking(0.6)}};
  EXPECT_FALSE(IsOrdered(stage));
  EXPECT_DOUBLE_EQ(DurationOf(stage), 0.75);
  StageClock clock(stage, 100);
  EXPECT_EQ(clock.TakeTurns(0), (Steps{0, 1, 2}));
  EXPECT_EQ(clock.TakeBegun(0), (Steps{0, 2}));
  EXPECT_EQ(clock.End(), 75);
  EXPECT_EQ(clock.TakeBegun(49), Steps{});
  EXPECT_EQ(clock.TakeBegun(50), Steps{1});
  EXPECT_EQ(clock.BeginOf(1), 50);
  EXPECT_EQ(clock.EndOf(1), 75);
}

TEST(StageClock, StepsOfAnActorFollowEachOther) {
  const ScriptStage stage{.steps = {Waiting(0, 0.5), Waiting(1, 0.2), Waiting(0, 0.3)}};
  EXPECT_TRUE(IsOrdered(stage));
  EXPECT_DOUBLE_EQ(DurationOf(stage), 0.8);
  StageClock clock(stage, 100);
  EXPECT_EQ(clock.TakeTurns(0), (Steps{0, 1}));
  EXPECT_EQ(clock.TakeBegun(0), (Steps{0, 1}));
  EXPECT_EQ(clock.End(), std::nullopt) << "one still waits";
  clock.Finish(1);
  EXPECT_EQ(clock.TakeTurns(20), Steps{});
  clock.SetEnd(0, 40);  // earlier than planned
  clock.Finish(0);
  EXPECT_EQ(clock.TakeTurns(40), Steps{2});
  EXPECT_EQ(clock.TakeBegun(40), Steps{2});
  EXPECT_EQ(clock.End(), 70);
}

TEST(StageClock, AfterAndWithNameOtherSteps) {
  const ScriptStage stage{.steps = {Waiting(0, 0.5, {.name = "first"}, 0.1),
                                    Waiting(1, 0.2, {.name = "second", .after = "first"}, 0.1),
                                    Waiting(2, 0.2, {.with = "second"}, 0.4)},
                          .person_steps = {Walking(0.1, {.after = "second"})}};
  EXPECT_DOUBLE_EQ(DurationOf(stage), 1.3) << "0.1 + 0.5, + 0.1, + 0.4 + 0.2";
  StageClock clock(stage, 100);
  EXPECT_EQ(clock.TakeTurns(0), Steps{0});
  EXPECT_EQ(clock.TakeBegun(10), Steps{0});
  EXPECT_EQ(clock.TakeTurns(59), Steps{});
  clock.Finish(0);
  EXPECT_EQ(clock.TakeTurns(60), Steps{1});
  EXPECT_EQ(clock.TakeTurns(60), Steps{}) << "a step with a delay has not begun";
  EXPECT_EQ(clock.TakeBegun(70), Steps{1});
  EXPECT_EQ(clock.TakeTurns(70), Steps{2});
  clock.Finish(1);
  EXPECT_EQ(clock.TakeTurns(90), Steps{3});
  EXPECT_EQ(clock.TakeBegun(90), Steps{3});
  EXPECT_FALSE(clock.IsStuck());
}

TEST(StageClock, StepsThatNeverBeginAreFound) {
  const ScriptStage circle{.steps = {Waiting(0, 0.5, {.after = "last"}),
                                     Waiting(0, 0.2, {.name = "last"}), Waiting(1, 0.3)}};
  EXPECT_EQ(StuckSteps(circle), (Steps{0, 1}));
  EXPECT_EQ(StuckSteps({.steps = {Waiting(0, 0.5, {.name = "own", .with = "own"})}}), Steps{0});
  EXPECT_EQ(StuckSteps({.steps = {Waiting(0, 0.5, {.after = "nobody"})}}), Steps{0});
  EXPECT_EQ(StuckSteps({.steps = {Waiting(0, 0.5), Waiting(0, 0.5)}}), Steps{});
  StageClock clock(circle, 100);
  EXPECT_EQ(clock.TakeTurns(0), Steps{2});
  EXPECT_EQ(clock.TakeBegun(0), Steps{2});
  EXPECT_FALSE(clock.IsStuck());
  clock.Finish(2);
  EXPECT_TRUE(clock.IsStuck());
}

}  // namespace
}  // namespace prehend::physics
