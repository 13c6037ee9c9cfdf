// SPDX-License-Identifier: Apache-2.0
#include "harness/scenario/scenario/scenario.h"

#include <gtest/gtest.h>

namespace prehend::scenario {
namespace {

grammar::Tick ToleranceAt(int rate_hz, int sensing_hz) {
  Scenario scenario;
  scenario.scene.world.rate_hz = rate_hz;
  scenario.sensing.sensing_hz = sensing_hz;
  return DefaultTolerance(scenario);
}

TEST(ScenarioTolerance, IsTwoFramesInTicks) {
  EXPECT_EQ(ToleranceAt(480, 240), 4);
  EXPECT_EQ(ToleranceAt(480, 480), 2);
  EXPECT_EQ(ToleranceAt(480, 90), 11);  // 10.67: the next tick that is two frames later
  EXPECT_EQ(ToleranceAt(480, 96), 10);
}

}  // namespace
}  // namespace prehend::scenario
