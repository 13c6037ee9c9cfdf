// SPDX-License-Identifier: Apache-2.0
#include "tests/witnesses/metamorphic/metamorphic.h"

#include <gtest/gtest.h>

#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/truth/claims/claim.h"
#include "tests/witnesses/metamorphic/change_entities.h"
#include "tests/witnesses/metamorphic/move_scenario.h"

namespace prehend::witnesses {
namespace {

episode::LoadedRun Load(const std::string& scenario) {
  const std::string root = PREHEND_SOURCE_DIR;
  return episode::LoadRun({.scenario_file = root + "/scenarios/" + scenario + ".yaml"}, root)
      .value();
}

std::string WhyNot(const episode::LoadedRun& loaded, const std::string& transform) {
  const auto there = TransformedBy(loaded, transform);
  return there ? "" : there.error();
}

scenario::Scenario After(const episode::LoadedRun& loaded, const std::string& transform) {
  const auto there = TransformedBy(loaded, transform);
  if (there) return there->scenario;
  ADD_FAILURE() << there.error();
  return {};
}

TEST(Metamorphic, AMirrorImageOfAMirrorImageIsTheOriginal) {
  episode::LoadedRun loaded = Load("grasp/gem_of_flat_faces_is_grasped_and_placed");
  const scenario::Scenario original = loaded.scenario;
  loaded.scenario = After(loaded, "mirror");
  const scenario::Scenario twice = After(loaded, "mirror");
  ASSERT_EQ(twice.scene.bodies.size(), original.scene.bodies.size());
  for (std::size_t i = 0; i < twice.scene.bodies.size(); ++i) {
    const auto &a = twice.scene.bodies[i], &b = original.scene.bodies[i];
    EXPECT_EQ(a.X_WB.p_m, b.X_WB.p_m);
    EXPECT_EQ(a.X_WB.q.coeffs(), b.X_WB.q.coeffs());
  }
}

TEST(Metamorphic, RightHandsBecomeLeftOnes) {
  const episode::LoadedRun loaded = Load("pick_and_place/milk_carton_wrap");
  const scenario::Scenario& original = loaded.scenario;
  const scenario::Scenario mirrored = After(loaded, "mirror");
  EXPECT_FALSE(original.scene.hands[0].model.left);
  EXPECT_TRUE(mirrored.scene.hands[0].model.left);
  EXPECT_EQ(mirrored.scene.hands[0].X_WH.p_m.y(), -original.scene.hands[0].X_WH.p_m.y());
}

TEST(Metamorphic, OtherStoriesAreRefused) {
  EXPECT_EQ(WhyNot(Load("planar/disc_rolls_to_rest"), "turn"), "it is planar");
  EXPECT_EQ(WhyNot(Load("gaze/eyes_lead_the_hand"), "mirror"),
            "a person's right hand would be on the left");
}

TEST(Metamorphic, NoiseMakesAnotherStory) {
  const episode::LoadedRun noisy = Load("sensors/missed_touches_are_bridged");
  EXPECT_EQ(WhyNot(noisy, "mirror"),
            "the noise of its sensors is drawn along the axes of the world");
  for (const char* transform : {"reorder", "bystander", "copies"})
    EXPECT_EQ(WhyNot(noisy, transform),
              "the noise of its sensors is drawn for each entity by its place in the list");
  EXPECT_EQ(WhyNot(noisy, "rename"), "");
}

TEST(Metamorphic, WhoSeesEveryTickSeesNoMore) {
  episode::LoadedRun loaded = Load("planar/disc_rolls_to_rest");
  loaded.scenario.sensing.sensing_hz = 300;
  EXPECT_EQ(After(loaded, "watch").sensing.sensing_hz, 480);
  loaded.scenario.sensing.sensing_hz = 480;
  EXPECT_EQ(WhyNot(loaded, "watch"), "the grammar sees every tick already");
}

TEST(Metamorphic, WhatReachesFarHasNoRoomForACopy) {
  episode::LoadedRun loaded = Load("planar/disc_rolls_to_rest");
  loaded.scenario.scene.bodies[0].X_WB.p_m.x() = 7;
  EXPECT_EQ(WhyNot(loaded, "copies"),
            loaded.scenario.scene.bodies[0].name + " reaches too far for a copy beside it");
}

TEST(Metamorphic, NewNamesAreInTheOppositeOrder) {
  const episode::LoadedRun loaded = Load("gaze/eyes_lead_the_hand");
  const std::vector<physics::Body>& before = loaded.scenario.scene.bodies;
  const std::vector<physics::Body> after = After(loaded, "rename").scene.bodies;
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_TRUE(after[i].name.ends_with("_" + before[i].name));
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_EQ(before[i].name < before[j].name, after[j].name < after[i].name);
  }
}

TEST(Metamorphic, ACopyDoesWhatTheOriginalDoes) {
  const episode::LoadedRun loaded = Load("gaze/eyes_lead_the_hand");
  const scenario::Scenario& original = loaded.scenario;
  const scenario::Scenario both = After(loaded, "copies");
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

TEST(Metamorphic, PlacesThatOutcomesAskForMoveAlong) {
  const auto ends_near_m = [](const scenario::Scenario& scenario) {
    return scenario.outcomes.at(0).conditions.at(1).wanted.near_m.value();
  };
  const episode::LoadedRun loaded = Load("trials/wrap_places_a_carton");
  const scenario::Scenario& original = loaded.scenario;
  ASSERT_EQ(ends_near_m(original), (std::vector<double>{0.15, -0.25}));
  EXPECT_EQ(ends_near_m(After(loaded, "mirror")), (std::vector<double>{0.15, 0.25}));
  EXPECT_EQ(ends_near_m(After(loaded, "far")), (std::vector<double>{4.15, 1.75}));
  const scenario::Scenario turned =
      Moved(original, {.X = {.q = physics::FromRollPitchYaw({0, 0, 90})}});
  EXPECT_NEAR(ends_near_m(turned)[0], 0.25, 1e-12);
  EXPECT_NEAR(ends_near_m(turned)[1], 0.15, 1e-12);
}

/// What was recognised, and the same as a golden.
std::pair<suite::CheckedRun, truth::Golden> Here(episode::LoadedRun loaded) {
  suite::CheckedRun here{.id = "x", .loaded = std::move(loaded), .result = {}, .explain = ""};
  here.result = episode::RunScenario(here.loaded.scenario, here.loaded.program);
  truth::Golden golden{.ticks_per_second = here.result.timeline.ticks_per_second};
  for (const grammar::NamedEvent& event : here.result.timeline.events)
    golden.events.push_back({.event = event});
  EXPECT_FALSE(golden.events.empty());
  return {std::move(here), std::move(golden)};
}

class SameStory : public testing::TestWithParam<std::string> {};

// Who touches whom is symmetric: the alphabet decides who is named first.
TEST_P(SameStory, HasTheSameEvents) {
  const auto [here, golden] = Here(Load("reach/slow_approach_is_one_reach"));
  const TransformVerdict judged = JudgeTransform(here, golden, GetParam());
  EXPECT_EQ(judged.says, kSameStory) << judged.why << "\n" << judged.details;
  EXPECT_EQ(judged.transform, GetParam());
}

INSTANTIATE_TEST_SUITE_P(All, SameStory, testing::ValuesIn(TransformNames()),
                         [](const auto& row) { return row.param; });

// `until`, `orbit` and `press_n` name things, too.
TEST(Metamorphic, WhatScriptsNameHasItsNewName) {
  for (const char* scenario : {"reach/resting_beside_a_can_before_it_is_taken",
                               "slide/sponge_is_pressed_and_wipes_the_table"}) {
    const auto [here, golden] = Here(Load(scenario));
    for (const char* transform : {"rename", "copies"}) {
      const TransformVerdict judged = JudgeTransform(here, golden, transform);
      EXPECT_EQ(judged.says, kSameStory) << transform << ": " << judged.why;
    }
  }
  scenario::Scenario orbits = Load("reach/slow_approach_is_one_reach").scenario;
  orbits.script.stages[0].steps[0].action = physics::OrbitStep{.around = "milk"};
  const scenario::Scenario renamed = Renamed(orbits, {{"milk", "e1"}});
  EXPECT_EQ(std::get<physics::OrbitStep>(renamed.script.stages[0].steps[0].action).around, "e1");
}

// 0.3 s of waiting last 0.3 s at every rate; an event that has moved by more than 50 ms differs.
TEST(Metamorphic, OtherRatesAreComparedInSeconds) {
  auto [here, golden] = Here(Load("reach/slow_approach_is_one_reach"));
  grammar::Interval& interval = golden.events.at(0).event.interval;
  const auto says = [&] { return JudgeTransform(here, golden, "rate").says; };
  interval.end += golden.ticks_per_second / 100;
  EXPECT_EQ(says(), kSameStory);
  interval.end += golden.ticks_per_second / 10;
  EXPECT_EQ(says(), kOtherStory);
}

// A golden may be marked as unsteady; what the scenario expects must hold everywhere all the same.
TEST(Metamorphic, ClaimsAreJudgedInEachPlay) {
  episode::LoadedRun loaded = Load("planar/disc_rolls_to_rest");
  loaded.scenario.expects = {truth::ParseClaim("no contact(disc, ramp)").value()};
  auto [here, golden] = Here(std::move(loaded));
  EXPECT_EQ(JudgeTransform(here, golden, "nudge").says, kSameStory)
      << "it does not hold here either";
  golden.unsteady = "chaos";
  here.result.timeline.events.clear();
  const TransformVerdict judged = JudgeTransform(here, golden, "nudge");
  EXPECT_EQ(judged.says, kOtherStory);
  EXPECT_NE(judged.why.find("nudge: expects: 'no contact(disc, ramp)'"), std::string::npos)
      << judged.why;
  EXPECT_NE(judged.details.find("contact(disc, ramp) 0.0"), std::string::npos) << judged.details;
}

TEST(Metamorphic, WhatMayDifferIsSaid) {
  auto [here, golden] = Here(Load("planar/disc_rolls_to_rest"));
  golden.events.pop_back();
  EXPECT_EQ(JudgeTransform(here, golden, "nudge").says, kOtherStory);
  golden.unsteady = "chaos";
  const TransformVerdict judged = JudgeTransform(here, golden, "nudge");
  EXPECT_EQ(judged.says, kMayDiffer);
  EXPECT_EQ(judged.why, "chaos");
}

}  // namespace
}  // namespace prehend::witnesses
