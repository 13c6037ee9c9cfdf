// SPDX-License-Identifier: Apache-2.0
// The first tick and entity where two runs part is found, also after a way through a file.
#include <gtest/gtest.h>
#include <unistd.h>

#include "harness/base/base/atomic_file.h"
#include "harness/suite/check/last_pass.h"

namespace prehend::suite {
namespace {

physics::Scene TwoBodies() {
  physics::Scene scene;
  scene.bodies.resize(2);
  scene.bodies[0].name = "cup";
  scene.bodies[1].name = "milk";
  return scene;
}

std::vector<physics::Snapshot> Recording(int count) {
  std::vector<physics::Snapshot> recording(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    recording[i].tick = 2 * i;
    recording[i].bodies.resize(2);
    recording[i].bodies[0].X_WB.p_m.x() = 0.1 * i;
  }
  return recording;
}

TEST(StateTrace, FindsWhereTwoRunsPart) {
  const physics::Scene scene = TwoBodies();
  const StateTrace trace = TraceOf(scene, Recording(10));
  EXPECT_FALSE(FirstDivergence(trace, trace));

  auto other = Recording(10);
  other[7].bodies[1].v_WB_m_per_s.z() = 1e-12;
  const auto divergence = FirstDivergence(trace, TraceOf(scene, other));
  ASSERT_TRUE(divergence);
  EXPECT_EQ(divergence->tick, 14);
  EXPECT_EQ(divergence->entity, "milk");

  const auto shorter = FirstDivergence(trace, TraceOf(scene, Recording(8)));
  ASSERT_TRUE(shorter);
  EXPECT_EQ(shorter->tick, 16);
  EXPECT_EQ(shorter->entity, "");
}

TEST(StateTrace, WhatDidNotMoveIsAsItWas) {
  auto recording = Recording(10);
  const StateTrace trace = TraceOf(TwoBodies(), recording);
  for (physics::Snapshot& snapshot : recording)
    snapshot.moved_tick = {snapshot.tick, snapshot.tick < 6 ? 0 : 6};
  EXPECT_EQ(TraceOf(TwoBodies(), recording), trace);

  // Only what may have moved is looked at.
  recording[2].bodies[1].X_WB.p_m.y() = 1;
  EXPECT_EQ(TraceOf(TwoBodies(), recording), trace);
  recording[3].bodies[1].X_WB.p_m.y() = 1;
  EXPECT_NE(TraceOf(TwoBodies(), recording), trace);
}

TEST(StateTrace, LongRecordingsAreThinned) {
  const StateTrace trace = TraceOf(TwoBodies(), Recording(50'001));
  EXPECT_LE(trace.ticks.size(), 20'000u);
  EXPECT_GE(trace.ticks.size(), 10'000u);
  EXPECT_EQ(trace.hashes.size(), 2 * trace.ticks.size());
}

TEST(StateTrace, ComesBackFromItsFile) {
  const auto path =
      std::filesystem::temp_directory_path() / ("prehend-trace-" + std::to_string(getpid()));
  EXPECT_FALSE(ReadTrace(path));
  const StateTrace trace = TraceOf(TwoBodies(), Recording(10));
  ASSERT_EQ(WriteTrace(path, trace), "");
  EXPECT_EQ(ReadTrace(path), trace);
  for (const char* damaged :
       {"", "{}", "[1]", R"({"entities": ["cup"], "ticks": [0], "hashes": []})",
        R"({"entities": ["cup"], "ticks": ["zz"], "hashes": [1]})",
        R"({"entities":["cup"],"hashes":[1],"ticks":[0)",
        R"({"entities":["cup"],"hashes":[1,x],"ticks":[0,1]})",
        R"({"entities":["cup"],"hashes":[1,4294967296],"ticks":[0,1]})",
        R"({"entities":["cup","hashes":[1],"ticks":[0]})", R"(],"ticks":[]})"}) {
    ASSERT_EQ(WriteTextFile(path, damaged), "");
    EXPECT_FALSE(ReadTrace(path)) << damaged;
  }
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace prehend::suite
