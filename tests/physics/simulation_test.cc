// SPDX-License-Identifier: Apache-2.0
// The whole room end to end: scenes and scripts in, states of the world out.
#include "physics/simulation.h"

#include <gtest/gtest.h>

#include "tests/physics/library_hand.h"

namespace prehend::physics {
namespace {

TEST(SimulationTest, EmptySceneCompletesAfterSettling) {
  Simulation simulation({}, {.settle_s = 0.1});
  int ticks = 0;
  while (simulation.Step()) ++ticks;
  EXPECT_EQ(ticks, 48);
  EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kCompleted);
  EXPECT_EQ(simulation.status().tick, 48);
}

}  // namespace
}  // namespace prehend::physics
