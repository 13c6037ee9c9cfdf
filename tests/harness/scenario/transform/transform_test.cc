// SPDX-License-Identifier: Apache-2.0
#include "harness/scenario/transform/transform.h"

#include <gtest/gtest.h>

#include "harness/episode/run/load_run.h"

namespace prehend::scenario {
namespace {

episode::LoadedRun Load(const std::string& scenario) {
  const std::string root = PREHEND_SOURCE_DIR;
  return episode::LoadRun({.scenario_file = root + "/scenarios/" + scenario + ".yaml"}, root)
      .value();
}

Scenario After(const Scenario& scenario, Transform transform) {
  const auto transformed = Transformed(scenario, transform);
  if (transformed) return *transformed;
  ADD_FAILURE() << transformed.error();
  return {};
}

TEST(Transform, NoiseMakesAnotherStory) {
  const Scenario noisy = Load("sensors/missed_touches_are_bridged").scenario;
  for (const Transform transform : {Transform::kReorder, Transform::kBystander})
    EXPECT_EQ(Transformed(noisy, transform).error(),
              "the noise of its sensors is drawn for each entity by its place in the list");
  EXPECT_TRUE(Transformed(noisy, Transform::kShift));
}

TEST(Transform, ReorderingKeepsWhatBelongsTogether) {
  const Scenario original = Load("furniture/door_is_opened_with_four_fingers").scenario;
  const Scenario reordered = After(original, Transform::kReorder);
  const auto joints_of = [](const Scenario& scenario) {
    std::vector<std::pair<std::string, std::string>> names;
    for (const physics::Joint& joint : scenario.scene.joints)
      names.emplace_back(At(scenario.scene.bodies, joint.body).name,
                         At(scenario.scene.bodies, joint.base).name);
    return names;
  };
  EXPECT_EQ(joints_of(reordered), joints_of(original));
  EXPECT_EQ(reordered.scene.bodies.front().name, original.scene.bodies.back().name);
}

TEST(Transform, PlacesThatOutcomesAskForMoveAlong) {
  const Scenario original = Load("trials/wrap_places_a_carton").scenario;
  const Scenario far = After(original, Transform::kFar);
  EXPECT_EQ(far.outcomes.at(0).conditions.at(1).wanted.near_m.value(),
            (std::vector<double>{4.15, 1.75}));
}

}  // namespace
}  // namespace prehend::scenario
