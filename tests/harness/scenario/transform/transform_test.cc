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
  EXPECT_EQ(Transformed(noisy, Transform::kTurn).error(),
            "the noise of its sensors is drawn along the axes of the world");
  EXPECT_TRUE(Transformed(noisy, Transform::kShift));
  EXPECT_EQ(Transformed(Load("planar/disc_rolls_to_rest").scenario, Transform::kTurn).error(),
            "it is planar");
  EXPECT_EQ(Transformed(Load("tracking/tremor_of_the_hand_is_no_slide").scenario, Transform::kTurn)
                .error(),
            "the noise of its tracker is drawn along the axes of the world");
}

// Places as they stand in the world, directions without where it stands.
TEST(Transform, AWorldThatIsTurnedAndMovedHasOtherPlacesAndDirections) {
  Scenario original = Load("furniture/door_is_opened_with_four_fingers").scenario;
  original.script.stages.at(0).steps.at(0).action = physics::MoveStep{.by_m = {0.1, 0, 0.2}};
  original.script.stages.at(1).steps.at(0).action = physics::CarryStep{.to_m = {0.3, 0.1}};
  const physics::Pose X{{1, 2, 0}, physics::FromRollPitchYaw({0, 0, 90})};
  const Scenario moved = Moved(original, X);
  const physics::Joint &before = original.scene.joints.at(0), &after = moved.scene.joints.at(0);
  EXPECT_TRUE(after.pivot_W_m.isApprox(X * before.pivot_W_m, 1e-12));
  EXPECT_TRUE(after.axis_W.isApprox(X.q * before.axis_W, 1e-12));
  EXPECT_TRUE(moved.scene.hands.at(0).X_WH.p_m.isApprox(X * original.scene.hands.at(0).X_WH.p_m));
  const auto& steps = moved.script.stages;
  EXPECT_TRUE(std::get<physics::MoveStep>(steps.at(0).steps.at(0).action)
                  .by_m.isApprox(Eigen::Vector3d(0, 0.1, 0.2), 1e-12));
  EXPECT_TRUE(std::get<physics::CarryStep>(steps.at(1).steps.at(0).action)
                  .to_m.isApprox(Eigen::Vector2d(0.9, 2.3), 1e-12));
}

// A micrometre is no reason for other last bits of rotations.
TEST(Transform, WhatIsOnlyMovedKeepsItsRotations) {
  const Scenario original = Load("grasp/gem_of_flat_faces_is_grasped_and_placed").scenario;
  const Scenario nudged = After(original, Transform::kNudge);
  for (std::size_t i = 0; i < original.scene.bodies.size(); ++i)
    EXPECT_EQ(nudged.scene.bodies[i].X_WB.q.coeffs(), original.scene.bodies[i].X_WB.q.coeffs());
  EXPECT_EQ(nudged.scene.hands[0].X_WH.q.coeffs(), original.scene.hands[0].X_WH.q.coeffs());
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
