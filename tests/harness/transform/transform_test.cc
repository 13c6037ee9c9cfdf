// SPDX-License-Identifier: Apache-2.0
#include "harness/transform/transform.h"

#include <gtest/gtest.h>

#include "harness/claims/parse_claim.h"
#include "harness/judge/judge_transforms.h"
#include "harness/run/load_run.h"
#include "harness/run/run_scenario.h"
#include "harness/transform/change_entities.h"
#include "harness/transform/move_scenario.h"

namespace prehend::harness {
namespace {

LoadedRun Load(const std::string& scenario) {
  const std::string root = PREHEND_SOURCE_DIR;
  return LoadRun({.scenario_file = root + "/scenarios/" + scenario + ".yaml"}, root).value();
}

Scenario After(const Scenario& scenario, Transform transform) {
  const auto transformed = Transformed(scenario, transform);
  if (transformed) return transformed->scenario;
  ADD_FAILURE() << transformed.error();
  return {};
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

TEST(Transform, NoiseMakesAnotherStory) {
  const Scenario noisy = Load("sensors/missed_touches_are_bridged").scenario;
  EXPECT_EQ(Transformed(noisy, Transform::kMirror).error(),
            "the noise of its sensors is drawn along the axes of the world");
  for (const Transform transform : {Transform::kReorder, Transform::kBystander, Transform::kCopies})
    EXPECT_EQ(Transformed(noisy, transform).error(),
              "the noise of its sensors is drawn for each entity by its place in the list");
  EXPECT_TRUE(Transformed(noisy, Transform::kRename));
}

TEST(Transform, WhoSeesEveryTickSeesNoMore) {
  LoadedRun loaded = Load("planar/disc_rolls_to_rest");
  loaded.scenario.sensing.sensing_hz = 300;
  EXPECT_EQ(After(loaded.scenario, Transform::kWatch).sensing.sensing_hz, 480);
  loaded.scenario.sensing.sensing_hz = 480;
  EXPECT_EQ(Transformed(loaded.scenario, Transform::kWatch).error(),
            "the grammar sees every tick already");
}

TEST(Transform, WhatReachesFarHasNoRoomForACopy) {
  LoadedRun loaded = Load("planar/disc_rolls_to_rest");
  loaded.scenario.scene.bodies[0].X_WB.p_m.x() = 7;
  EXPECT_EQ(Transformed(loaded.scenario, Transform::kCopies).error(),
            loaded.scenario.scene.bodies[0].name + " reaches too far for a copy beside it");
}

TEST(Transform, NewNamesAreInTheOppositeOrder) {
  const Scenario original = Load("gaze/eyes_lead_the_hand").scenario;
  const auto there = Transformed(original, Transform::kRename);
  ASSERT_TRUE(there);
  const auto &before = original.scene.bodies, &after = there->scenario.scene.bodies;
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(there->names.at(after[i].name), before[i].name);
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_EQ(before[i].name < before[j].name, after[j].name < after[i].name);
  }
}

TEST(Transform, ACopyDoesWhatTheOriginalDoes) {
  const Scenario original = Load("gaze/eyes_lead_the_hand").scenario;
  const Scenario both = After(original, Transform::kCopies);
  const std::size_t bodies = original.scene.bodies.size();
  ASSERT_EQ(both.scene.bodies.size(), 2 * bodies);
  for (std::size_t i = 0; i < bodies; ++i) {
    const physics::Body &body = both.scene.bodies[i], &copy = both.scene.bodies[bodies + i];
    EXPECT_EQ(copy.name, body.name + "_of_the_copy");
    EXPECT_NEAR(copy.X_WB.p_m.x() - body.X_WB.p_m.x(), 13, 1e-12);
  }
  ASSERT_EQ(both.scene.persons.size(), 2);
  EXPECT_EQ(both.scene.persons[1].head, both.scene.persons[0].head + static_cast<int>(bodies));
  EXPECT_EQ(both.scene.persons[1].right_hand, both.scene.persons[0].right_hand + 1);
  for (const physics::ScriptStage& stage : both.script.stages) {
    ASSERT_EQ(stage.steps.size() % 2, 0u);
    const std::size_t half = stage.steps.size() / 2;
    for (std::size_t i = 0; i < half; ++i) {
      EXPECT_EQ(stage.steps[half + i].hand, stage.steps[i].hand + 1);
      const auto* const reach = std::get_if<physics::ReachStep>(&stage.steps[half + i].action);
      if (reach) {
        EXPECT_EQ(reach->object,
                  std::get<physics::ReachStep>(stage.steps[i].action).object + "_of_the_copy");
      }
    }
  }
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

TEST(Transform, PlacesThatOutcomesAskForMoveAlong) {
  const auto ends_near_m = [](const Scenario& scenario) {
    return scenario.outcomes.at(0).conditions.at(1).wanted.near_m.value();
  };
  const Scenario original = Load("trials/wrap_places_a_carton").scenario;
  ASSERT_EQ(ends_near_m(original), (std::vector<double>{0.15, -0.25}));
  EXPECT_EQ(ends_near_m(After(original, Transform::kMirror)), (std::vector<double>{0.15, 0.25}));
  EXPECT_EQ(ends_near_m(After(original, Transform::kFar)), (std::vector<double>{4.15, 1.75}));
  const Scenario turned = Moved(original, {.X = {.q = physics::FromRollPitchYaw({0, 0, 90})}});
  EXPECT_NEAR(ends_near_m(turned)[0], 0.25, 1e-12);
  EXPECT_NEAR(ends_near_m(turned)[1], 0.15, 1e-12);
}

/// What was recognised, and the same as a golden.
std::pair<CheckedRun, Golden> Here(LoadedRun loaded) {
  CheckedRun here{.id = "x", .loaded = std::move(loaded), .result = {}, .explain = ""};
  here.result = RunScenario(here.loaded.scenario, here.loaded.program);
  Golden golden{.ticks_per_second = here.result.timeline.ticks_per_second};
  for (const grammar::NamedEvent& event : here.result.timeline.events)
    golden.events.push_back({.event = event});
  EXPECT_FALSE(golden.events.empty());
  return {std::move(here), std::move(golden)};
}

class SameStory : public testing::TestWithParam<TransformName> {};

// Who touches whom is symmetric: the alphabet decides who is named first.
TEST_P(SameStory, HasTheSameEvents) {
  const auto [here, golden] = Here(Load("reach/slow_approach_is_one_reach"));
  const TransformJudgement judged = JudgeTransforms(here, golden, {GetParam().transform});
  EXPECT_EQ(judged.verdicts.at(0).says, kSameStory) << judged.verdicts.at(0).why;
  EXPECT_EQ(judged.verdicts.at(0).transform, GetParam().name);
  for (const Finding& finding : judged.findings) ADD_FAILURE() << finding.details;
}

INSTANTIATE_TEST_SUITE_P(All, SameStory, testing::ValuesIn(TransformNames()),
                         [](const auto& row) { return std::string(row.param.name); });

// `until`, `orbit` and `press_n` name things, too.
TEST(Transform, WhatScriptsNameHasItsNewName) {
  for (const char* scenario : {"reach/resting_beside_a_can_before_it_is_taken",
                               "slide/sponge_is_pressed_and_wipes_the_table"}) {
    const auto [here, golden] = Here(Load(scenario));
    const TransformJudgement judged =
        JudgeTransforms(here, golden, {Transform::kRename, Transform::kCopies});
    for (const TransformVerdict& verdict : judged.verdicts)
      EXPECT_EQ(verdict.says, kSameStory) << verdict.transform << ": " << verdict.why;
  }
  Scenario orbits = Load("reach/slow_approach_is_one_reach").scenario;
  orbits.script.stages[0].steps[0].action = physics::OrbitStep{.around = "milk"};
  const Scenario renamed = Renamed(orbits, {{"milk", "e1"}});
  EXPECT_EQ(std::get<physics::OrbitStep>(renamed.script.stages[0].steps[0].action).around, "e1");
}

// 0.3 s of waiting last 0.3 s at every rate; an event that has moved by more than 50 ms differs.
TEST(Transform, OtherRatesAreComparedInSeconds) {
  auto [here, golden] = Here(Load("reach/slow_approach_is_one_reach"));
  grammar::Interval& interval = golden.events.at(0).event.interval;
  const auto says = [&] {
    return JudgeTransforms(here, golden, {Transform::kRate}).verdicts[0].says;
  };
  interval.end += golden.ticks_per_second / 100;
  EXPECT_EQ(says(), kSameStory);
  interval.end += golden.ticks_per_second / 10;
  EXPECT_EQ(says(), kOtherStory);
}

// A golden may be marked as unsteady; what the scenario expects must hold everywhere all the same.
TEST(Transform, ClaimsAreJudgedInEachPlay) {
  LoadedRun loaded = Load("planar/disc_rolls_to_rest");
  loaded.scenario.expects = {ParseClaim("no contact(disc, ramp)").value()};
  auto [here, golden] = Here(std::move(loaded));
  const TransformJudgement broken_here = JudgeTransforms(here, golden, {Transform::kNudge});
  EXPECT_TRUE(broken_here.findings.empty()) << "it does not hold here either";
  EXPECT_EQ(broken_here.verdicts[0].says, kSameStory);
  golden.unsteady = "chaos";
  const grammar::Timeline all = here.result.timeline;
  here.result.timeline.events.clear();
  const TransformJudgement judged =
      JudgeTransforms(here, golden, {Transform::kNudge, Transform::kTurn});
  ASSERT_EQ(judged.findings.size(), 1u);
  EXPECT_NE(judged.findings[0].reason.find("nudge: expects: 'no contact(disc, ramp)'"),
            std::string::npos)
      << judged.findings[0].reason;
  EXPECT_NE(judged.findings[0].details.find("contact(disc, ramp) 0.0"), std::string::npos);
  EXPECT_EQ(judged.verdicts[0].says, kOtherStory);
  EXPECT_EQ(judged.verdicts[1].says, kNotApplied);
  EXPECT_EQ(TextOfNotCompared(judged.verdicts), "turn: not applied: it is planar\n");
  const Ensemble ensemble = PlayEnsemble(here.loaded, all, golden);
  EXPECT_EQ(ensemble.plays_broken, 5);
  EXPECT_EQ(ensemble.broken.size(), 5u);
  EXPECT_TRUE(ensemble.differences.empty());
}

TEST(Transform, WhatMayDifferIsSaid) {
  auto [here, golden] = Here(Load("planar/disc_rolls_to_rest"));
  golden.events.pop_back();
  golden.unsteady = "chaos";
  const TransformJudgement judged = JudgeTransforms(here, golden, {Transform::kNudge});
  EXPECT_TRUE(judged.findings.empty());
  EXPECT_EQ(TextOfNotCompared(judged.verdicts), "nudge: may differ: chaos\n");
}

}  // namespace
}  // namespace prehend::harness
