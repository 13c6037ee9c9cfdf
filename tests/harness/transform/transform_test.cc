// SPDX-License-Identifier: Apache-2.0
#include "harness/transform/transform.h"

#include <gtest/gtest.h>

#include "harness/golden/compare.h"
#include "harness/run/load_run.h"
#include "harness/run/run_scenario.h"

namespace prehend::harness {
namespace {

LoadedRun Load(const std::string& scenario) {
  const std::string root = PREHEND_SOURCE_DIR;
  return LoadRun({.scenario_file = root + "/scenarios/" + scenario + ".yaml"}, root).value();
}

Scenario After(const Scenario& scenario, Transform transform) {
  const auto transformed = Transformed(scenario, transform);
  EXPECT_TRUE(transformed) << transformed.error();
  return transformed.value_or(Scenario{});
}

TEST(Transform, AMirrorImageOfAMirrorImageIsTheOriginal) {
  const Scenario original = Load("grasp/gem_of_flat_faces_is_grasped_and_placed").scenario;
  const Scenario twice = After(After(original, Transform::kMirror), Transform::kMirror);
  ASSERT_EQ(twice.scene.bodies.size(), original.scene.bodies.size());
  for (std::size_t i = 0; i < twice.scene.bodies.size(); ++i) {
    const auto &a = twice.scene.bodies[i], &b = original.scene.bodies[i];
    EXPECT_EQ(a.X_WB.p_m, b.X_WB.p_m);
    EXPECT_EQ(a.X_WB.q.coeffs(), b.X_WB.q.coeffs());
  }
}

TEST(Transform, RightHandsBecomeLeftOnes) {
  const Scenario original = Load("pick_and_place/milk_carton_wrap").scenario;
  const Scenario mirrored = After(original, Transform::kMirror);
  EXPECT_FALSE(original.scene.hands[0].model.left);
  EXPECT_TRUE(mirrored.scene.hands[0].model.left);
  EXPECT_EQ(mirrored.scene.hands[0].X_WH.p_m.y(), -original.scene.hands[0].X_WH.p_m.y());
}

TEST(Transform, OtherStoriesAreRefused) {
  const auto planar = Transformed(Load("planar/disc_rolls_to_rest").scenario, Transform::kTurn);
  ASSERT_FALSE(planar);
  EXPECT_EQ(planar.error(), "it is planar");
}

TEST(Transform, ReorderingKeepsWhatBelongsTogether) {
  const Scenario original = Load("furniture/door_is_opened_with_four_fingers").scenario;
  const Scenario reordered = After(original, Transform::kReorder);
  const auto joints_of = [](const Scenario& scenario) {
    std::vector<std::pair<std::string, std::string>> names;
    for (const physics::Joint& joint : scenario.scene.joints)
      names.emplace_back(scenario.scene.bodies[static_cast<std::size_t>(joint.body)].name,
                         scenario.scene.bodies[static_cast<std::size_t>(joint.base)].name);
    return names;
  };
  EXPECT_EQ(joints_of(reordered), joints_of(original));
  EXPECT_EQ(reordered.scene.bodies.front().name, original.scene.bodies.back().name);
}

class SameStory : public testing::TestWithParam<TransformName> {};

TEST_P(SameStory, HasTheSameEvents) {
  const LoadedRun loaded = Load("reach/slow_approach_is_one_reach");
  const RunResult here = RunScenario(loaded.scenario, loaded.program);
  RunResult there = RunScenario(After(loaded.scenario, GetParam().transform), loaded.program);
  std::erase_if(there.timeline.events, [](const grammar::NamedEvent& event) {
    return event.roles.front().value.starts_with("bystander");
  });
  Golden expected{.ticks_per_second = here.timeline.ticks_per_second};
  for (const grammar::NamedEvent& event : here.timeline.events)
    expected.events.push_back({.event = event});
  EXPECT_FALSE(expected.events.empty());
  const Comparison comparison =
      Compare(expected, there.timeline, DefaultTolerance(loaded.scenario));
  EXPECT_TRUE(comparison.Agrees()) << DifferenceText(comparison, "");
}

INSTANTIATE_TEST_SUITE_P(All, SameStory, testing::ValuesIn(TransformNames()),
                         [](const auto& row) { return std::string(row.param.name); });

}  // namespace
}  // namespace prehend::harness
