// SPDX-License-Identifier: Apache-2.0
#include "physics/hand/script_player.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/physics/tabletop.h"

namespace prehend::physics {
namespace {

using Texts = std::vector<std::string>;

ScriptStage One(StepAction action, double over_s) {
  return {{{HandIndex(0), std::move(action), over_s}}};
}

/// The target at the end of a script, in a world that does not move.
TargetState EndOf(const Scene& scene, Script script, int* ticks = nullptr) {
  Simulation still(scene, {});
  ScriptPlayer player(scene, std::move(script));
  TargetState last;
  int count = 0;
  while (const auto* commands = player.Advance(still.snapshot())) {
    last = commands->front().target;
    ++count;
  }
  EXPECT_EQ(player.problem(), "");
  if (ticks) *ticks = count;
  return last;
}

TEST(ScriptPlayerTest, MovesAreRelativeAndTriggersLast) {
  const Scene scene = MakeScene({});
  int ticks = 0;
  const TargetState end =
      EndOf(scene,
            {.stages = {One(MoveStep{{0.1, 0, 0}}, 0.5), One(TriggerStep{0.7}, 0.25),
                        One(MoveStep{{0, 0, 0.2}}, 0.5)},
             .settle_s = 0.25},
            &ticks);
  EXPECT_EQ(ticks, 720);
  EXPECT_LT((end.X_WH.p_m - (scene.hands[0].X_WH.p_m + Eigen::Vector3d(0.1, 0, 0.2))).norm(),
            1e-12);
  EXPECT_NEAR(end.trigger, 0.7, 1e-12);
  EXPECT_EQ(end.v_m_per_s, Eigen::Vector3d::Zero());
}

TEST(ScriptPlayerTest, ADelayedStepBeginsLaterAndProlongsItsStage) {
  const Scene scene = MakeScene({});
  Step step{HandIndex(0), MoveStep{{0.1, 0, 0}}, 0.5};
  step.delay_s = 0.25;
  Simulation still(scene, {});
  ScriptPlayer player(scene, {.stages = {{{step}}}, .settle_s = 0});
  const Eigen::Vector3d start = scene.hands[0].X_WH.p_m;
  std::vector<double> moved_m;
  while (const auto* commands = player.Advance(still.snapshot()))
    moved_m.push_back(commands->front().target.X_WH.p_m.x() - start.x());
  ASSERT_EQ(moved_m.size(), 360u) << "0.75 s at 480 Hz";
  EXPECT_EQ(moved_m[119], 0) << "it rests for 0.25 s";
  EXPECT_GT(moved_m[125], 0);
  EXPECT_NEAR(moved_m[239], 0.05, 1e-9) << "half of the way in the middle of the motion";
  EXPECT_NEAR(moved_m.back(), 0.1, 1e-12);
}

TEST(ScriptPlayerTest, WhatADelayedStepSaysIsResolvedWhenItBegins) {
  const Scene scene = MakeScene({});
  Step reach{HandIndex(0), ReachStep{"nobody"}, 0.5};
  reach.delay_s = 0.5;
  Simulation still(scene, {});
  ScriptPlayer player(scene, {.stages = {{{reach}}}, .settle_s = 0});
  int ticks = 0;
  while (player.Advance(still.snapshot())) ++ticks;
  EXPECT_EQ(ticks, 240);
  EXPECT_EQ(player.problem(), "reach: there is no entity 'nobody'");
}

TEST(ScriptPlayerTest, CarryBringsTheObjectsCentreThere) {
  const Scene scene = MakeScene({});
  const ScriptStage reach = One(ReachStep{"object"}, 0.5);
  const TargetState reached = EndOf(scene, {.stages = {reach}});
  const TargetState carried = EndOf(scene, {.stages = {reach, One(CarryStep{{0.2, -0.4}}, 0.5)}});
  // The object stands at (0.2, 0.1).
  EXPECT_LT((carried.X_WH.p_m - reached.X_WH.p_m - Eigen::Vector3d(0, -0.5, 0)).norm(), 1e-9);
}

TEST(ScriptPlayerTest, RetreatGoesBackTheWayItCame) {
  const Scene scene = MakeScene({});
  const ScriptStage reach = One(ReachStep{"object", "wrap", Approach::kAbove}, 0.5);
  const TargetState reached = EndOf(scene, {.stages = {reach}});
  const TargetState retreated = EndOf(scene, {.stages = {reach, One(RetreatStep{0.2}, 0.5)}});
  EXPECT_LT((retreated.X_WH.p_m - reached.X_WH.p_m - Eigen::Vector3d(0, 0, 0.2)).norm(), 1e-9);
}

TEST(ScriptPlayerTest, RetreatTurnsWithTheHand) {
  const Scene scene = MakeScene({});
  const ScriptStage reach = One(ReachStep{"object", "wrap", Approach::kSide}, 0.5),
                    retreat = One(RetreatStep{0.2}, 0.5);
  const auto way_m = [&](const std::vector<ScriptStage>& turns) {
    std::vector<ScriptStage> stages = {reach};
    stages.insert(stages.end(), turns.begin(), turns.end());
    const Eigen::Vector3d before_m = EndOf(scene, {.stages = stages}).X_WH.p_m;
    stages.push_back(retreat);
    return Eigen::Vector3d(EndOf(scene, {.stages = stages}).X_WH.p_m - before_m);
  };
  const Eigen::Vector3d back_m = way_m({}), left_m(-back_m.y(), back_m.x(), 0);
  const ScriptStage turn = One(TurnHandStep{{0, 0, M_PI / 4}}, 0.5);
  EXPECT_LT((way_m({turn, turn}) - left_m).norm(), 1e-9);
  EXPECT_LT((way_m({turn, One(OrbitStep{"table", M_PI / 4}, 0.5)}) - left_m).norm(), 1e-9);
  const Eigen::Quaterniond quarter(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  const PosesStep poses{.poses = {{0.5, {{0, 0, 0.1}, quarter}, {}}},
                        .frames = {{.own_hand = true, .world_axes = true}}};
  EXPECT_LT((way_m({One(poses, 0.5)}) - left_m).norm(), 1e-9);
  // It stops at once, when it has not turned.
  ScriptStage stopped = turn;
  stopped.steps[0].until = Until{.thing = "object", .gap_m = 1.0};
  EXPECT_LT((way_m({stopped}) - back_m).norm(), 0.001);
}

/// What is said of the first stage.
Texts NotesOf(const Scene& scene, const ScriptStage& stage) {
  const Script script{.stages = {stage}};
  Simulation still(scene, {});
  ScriptPlayer player(scene, script);
  player.Advance(still.snapshot());
  Texts texts;
  for (const auto& note : player.notes()) texts.push_back(note.text);
  return texts;
}

TEST(ScriptPlayerTest, NotesAReachThatCannotKeepClear) {
  const ScriptStage from_above = One(ReachStep{"object", "wrap", Approach::kAbove}, 0.5);
  Scene scene = MakeScene({});
  EXPECT_EQ(NotesOf(scene, from_above), Texts{});
  Body roof{.name = "roof", .shapes = {{Box{{1, 1, 0.02}}, {}}}, .fixed = true};
  roof.X_WB.p_m = {0.2, 0.1, 1.05};
  scene.bodies.push_back(roof);
  EXPECT_EQ(NotesOf(scene, from_above),
            Texts{"no way to grasp object keeps clear of everything: the open hand will push 22 mm "
                  "into roof; try 'from: side', another style or 'point_m', or make room"});
}

TEST(ScriptPlayerTest, NotesAThingThatIsTooWideForTheStyle) {
  Scene scene = MakeScene({});
  scene.bodies[1].shapes = {{Box{{0.14, 0.20, 0.10}}, {}}};
  ReachStep reach{"object", "wrap", Approach::kAbove};
  EXPECT_EQ(
      NotesOf(scene, One(reach, 0.5)),
      Texts{"style wrap opens 85 mm, and object is 140 mm wide there: the hand will not close "
            "around it; take it at a narrower part with 'point_m', in another style, or with "
            "two hands"});
  Scene as_wide = MakeScene({});
  as_wide.bodies[1].shapes = {{Box{{0.0852, 0.20, 0.10}}, {}}};  // within a rounding of 85 mm
  EXPECT_EQ(NotesOf(as_wide, One(reach, 0.5)), Texts{});
  reach.offset_m = {-0.1, 0, 0.1};  // to miss on purpose
  EXPECT_EQ(NotesOf(scene, One(reach, 0.5)), Texts{});
  // What is in the way besides is said, too.
  Body roof{.name = "roof", .shapes = {{Box{{1, 1, 0.02}}, {}}}, .fixed = true};
  roof.X_WB.p_m = {0.2, 0.1, 0.95};
  scene.bodies.push_back(roof);
  reach.offset_m.setZero();
  const Texts said = NotesOf(scene, One(reach, 0.5));
  ASSERT_EQ(said.size(), 1u);
  EXPECT_TRUE(said[0].starts_with("style wrap opens 85 mm, and object is 140 mm wide")) << said[0];
  EXPECT_NE(said[0].find(" mm into roof; try 'from: side'"), std::string::npos) << said[0];
}

TEST(ScriptPlayerTest, AWidthIsThatOfTheShapeNotOfItsTurnedBox) {
  Scene scene = MakeScene({.shape = Sphere{0.12}, .yaw_rad = M_PI / 4});
  EXPECT_EQ(
      NotesOf(scene, One(ReachStep{"object", "wrap", Approach::kAbove}, 0.5)),
      Texts{"style wrap opens 85 mm, and object is 240 mm wide there: the hand will not close "
            "around it; take it at a narrower part with 'point_m', in another style, or with "
            "two hands"});
}

/// The notes of a whole run in which the hand reaches, then closes.
Texts NotesOfGrasp(const Scene& scene, const ReachStep& reach, double grip_before) {
  Script script{.stages = {One(reach, 0.6), One(TriggerStep{1}, 0.4)}};
  if (grip_before > 0)
    script.stages.insert(script.stages.begin(), One(TriggerStep{grip_before}, 0.2));
  Simulation simulation(scene, script);
  while (simulation.Step()) {
  }
  Texts texts;
  for (const auto& note : simulation.notes()) texts.push_back(note.text);
  return texts;
}

TEST(ScriptPlayerTest, NotesAHandThatComesHalfClosed) {
  const Scene scene = MakeScene({});
  EXPECT_EQ(NotesOfGrasp(scene, {"object"}, 0), Texts{});
  const Texts said = NotesOfGrasp(scene, {"object"}, 0.7);
  ASSERT_FALSE(said.empty());
  EXPECT_EQ(
      said[0],
      "it comes with its grip at 0.70, so its fingers push 13 mm into object on the way: write "
      "'open_to: 0' before the reach");
}

TEST(ScriptPlayerTest, NotesAHandThatClosesBesideItsThing) {
  const ReachStep above{"object", "wrap", Approach::kAbove, {0, 0, 0.15}};
  EXPECT_EQ(NotesOfGrasp(MakeScene({}), above, 0),
            Texts{"it has closed and does not hold object, which is 68 mm away: is the reach's "
                  "'offset_m' too large, has object moved, or is it too thin or too wide for this "
                  "style?"});
}

// The fingers arrive after the end of a short step.
TEST(ScriptPlayerTest, AHandThatTakesHoldLaterIsNotNoted) {
  const auto notes = [](const ScriptStage& after) {
    const Scene scene = MakeScene({});
    const Script script{
        .stages = {One(ReachStep{"object"}, 0.6), One(TriggerStep{1}, 0.01), after}};
    Simulation simulation(scene, script);
    while (simulation.Step()) {
    }
    return simulation.notes().size();
  };
  EXPECT_EQ(notes(One(WaitStep{}, 0.6)), 0u);
  EXPECT_EQ(notes(One(TriggerStep{0}, 0.01)), 1u) << "it opened before";
}

TEST(ScriptPlayerTest, NotesAMoveThatEndsElsewhere) {
  const auto notes = [](double down_m) {
    const Scene scene = MakeScene({});
    const double to_table_m = scene.hands[0].X_WH.p_m.z() - kTop_m;
    Simulation simulation(scene,
                          {.stages = {One(MoveStep{{0.1, -0.1, -to_table_m - down_m}}, 0.8),
                                      One(WaitStep{}, 0.2), One(MoveStep{{0, 0, 0.1}}, 0.6)}});
    while (simulation.Step()) {
    }
    Texts texts;
    for (const auto& note : simulation.notes()) texts.push_back(note.text);
    return texts;
  };
  EXPECT_EQ(notes(-0.03), Texts{}) << "it presses, as it is to";
  const Texts said = notes(0.2);
  ASSERT_EQ(said.size(), 2u) << "it presses on while it is lifted by less";
  for (const std::string& text : said) {
    EXPECT_TRUE(text.starts_with("the move ends with the hand ")) << text;
    EXPECT_TRUE(
        text.ends_with(" away from where it was to go, at table; the next step goes on "
                       "from where it was to go, not from where it is"))
        << text;
  }
}

TEST(ScriptPlayerTest, ABeatLastsAsLongAsItsLongestStep) {
  Scene scene = MakeScene({});
  scene.hands.push_back({"other", LibraryHand("human_left"), {{-0.3, 0.3, 1.1}}});
  int ticks = 0;
  EndOf(scene,
        {.stages = {{{{HandIndex(0), WaitStep{}, 0.1}, {HandIndex(1), WaitStep{}, 0.3}}}},
         .settle_s = 0},
        &ticks);
  EXPECT_EQ(ticks, 144);
}

TEST(ScriptPlayerTest, SayWhatIsUnknown) {
  const Scene scene = MakeScene({});
  Simulation still(scene, {});
  const std::pair<StepAction, const char*> cases[] = {{ReachStep{"ghost"}, "'ghost'"},
                                                      {ReachStep{"object", "claw"}, "'claw'"},
                                                      {PlaceStep{"shelf"}, "'shelf'"},
                                                      {PlaceStep{"table"}, "holds nothing"}};
  for (const auto& [action, said] : cases) {
    ScriptPlayer player(scene, {.stages = {One(action, 0.5)}});
    EXPECT_EQ(player.Advance(still.snapshot()), nullptr);
    EXPECT_NE(player.problem().find(said), std::string::npos) << player.problem();
    EXPECT_EQ(player.problem_hand(), HandIndex(0));
  }
}

TEST(ScriptPlayerTest, PlacingOnWhatIsNotBelowNamesTheStep) {
  Scene scene = MakeScene({});
  Body post{.name = "post", .shapes = {{Box{{0.1, 0.1, 0.3}}, {}}}, .fixed = true};
  post.X_WB.p_m = {0.9, 0, 0.9};
  scene.bodies.push_back(post);
  Simulation still(scene, {});
  ScriptStage place = One(PlaceStep{"post"}, 0.5);
  place.steps[0].written_at = "milk.yaml:12:5";
  ScriptPlayer player(scene, {.stages = {One(ReachStep{"object"}, 0.01), place}});
  while (player.Advance(still.snapshot())) {
  }
  EXPECT_EQ(
      player.problem(),
      "milk.yaml:12:5: place_on: no part of 'post' is below 'object'; 'hand' does not touch "
      "'object', which this step is to move: was that lost on the way? 'poses' tells where it is "
      "at each moment");
}

/// Whether the object touches the table.
bool Stands(const Snapshot& now) {
  return std::ranges::any_of(now.contacts, [](const ContactPoint& point) {
    return point.a.hand == kNone && point.b.hand == kNone &&
           std::minmax(point.a.body, point.b.body) ==
               std::minmax(BodyIndex(kTable), BodyIndex(kObject));
  });
}

Script HastyPutDown() {
  return {.stages = {One(ReachStep{"object"}, 0.8), One(TriggerStep{1}, 0.6),
                     One(MoveStep{{0, 0, 0.25}}, 0.15), One(CarryStep{{0.2, -0.3}}, 0.3),
                     One(PlaceStep{"table"}, 0.2), One(TriggerStep{0}, 0.3)}};
}

// A bucket and its bar: the bucket lands, not the bar.
TEST(ScriptPlayerTest, WhatIsGluedToWhatIsHeldIsPutDownWithIt) {
  Scene scene = MakeScene({});
  scene.bodies[kObject].X_WB.p_m.z() += 0.1;
  Body bar{.name = "bar", .shapes = {{Box{{0.02, 0.1, 0.02}}, {}}}, .mass_kg = 0.1};
  bar.X_WB.p_m = scene.bodies[kObject].X_WB.p_m + Eigen::Vector3d(0, 0, 0.15);
  scene.bodies.push_back(bar);
  scene.joints.push_back({.body = BodyIndex(2), .base = BodyIndex(kObject)});
  const ScriptStage reach = One(ReachStep{"bar"}, 0.01);
  Simulation still(scene, {});
  ScriptPlayer player(scene, {.stages = {reach, One(PlaceStep{"table"}, 0.5)}});
  // Until the step should be over: then it seeks, as nothing lands in a world that does not move.
  double at_m = 0, down_m = 0;
  for (int i = 0; i < 5 + 240; ++i) {
    const double z_m = player.Advance(still.snapshot())->front().target.X_WH.p_m.z();
    if (i < 5) at_m = z_m;
    down_m = at_m - z_m;
  }
  EXPECT_GT(down_m, 0.102);
  EXPECT_LT(down_m, 0.112) << "2 mm, and at most 10 mm of the palm's spring";
}

TEST(ScriptPlayerTest, NotesWhatIsLostOnTheWay) {
  Scene scene = MakeScene({});
  scene.hands.push_back({"other", scene.hands[0].model, {{-0.2, 0.4, 1.05}}});
  Simulation still(scene, {});
  Snapshot in_other_hand = still.snapshot();
  in_other_hand.contacts.push_back({.a = {.hand = HandIndex(1)}, .b = {.body = BodyIndex(1)}});
  for (const auto& [step, now] : {std::pair(StepAction(CarryStep{{0.2, -0.4}}), still.snapshot()),
                                  std::pair(StepAction(CarryStep{{0.2, -0.4}}), in_other_hand),
                                  std::pair(StepAction(PlaceStep{"table"}), in_other_hand)}) {
    ScriptPlayer player(scene, {.stages = {One(ReachStep{"object"}, 0.01), One(step, 0.5)}});
    while (player.Advance(now)) {
    }
    EXPECT_EQ(player.problem(), "");
    // The hand of a world that does not move gets nowhere, either.
    const auto says = [](const char* text) {
      return [text](const ScriptNote& note) { return note.text.starts_with(text); };
    };
    const bool carries = std::holds_alternative<CarryStep>(step);
    EXPECT_EQ(player.notes().size(), carries ? 2u : 1u);
    EXPECT_EQ(std::ranges::count_if(player.notes(), says("the move ends with the hand ")), carries);
    EXPECT_EQ(
        std::ranges::count_if(
            player.notes(),
            says("'hand' does not touch 'object', which this step is to move: was that lost on "
                 "the way? 'poses' tells where it is at each moment")),
        1);
  }
}

TEST(ScriptPlayerTest, AFistThatHasLetGoMissesNothing) {
  const auto notes = [](std::vector<ScriptStage> stages) {
    stages.insert(stages.begin(), {One(ReachStep{"object"}, 0.6), One(TriggerStep{1}, 0.4)});
    const Scene scene = MakeScene({});
    Simulation simulation(scene, {.stages = std::move(stages)});
    while (simulation.Step()) {
    }
    return simulation.notes().size();
  };
  const ScriptStage opens = One(TriggerStep{0}, 0.3), leaves = One(MoveStep{{-0.2, 0, 0.1}}, 0.5),
                    closes = One(TriggerStep{1}, 0.4);
  EXPECT_EQ(notes({opens, leaves, closes}), 0u);
  EXPECT_EQ(notes({opens, leaves,
                   One(ReachStep{"object", "wrap", Approach::kAbove, {0, 0, 0.15}}, 0.6), closes}),
            1u)
      << "it reached for it again";
}

TEST(ScriptPlayerTest, WhatIsPutDownInHasteStandsBeforeTheHandOpens) {
  Simulation run(MakeScene({}), HastyPutDown());
  bool closed = false, opens = false;
  while (!opens && run.Step()) {
    const double trigger = run.snapshot().hands[0].trigger;
    opens = closed && trigger < 1;
    closed = trigger == 1;
  }
  ASSERT_TRUE(opens);
  EXPECT_TRUE(Stands(run.snapshot()));
  const double planned_s = 0.8 + 0.6 + 0.15 + 0.3 + 0.2;
  EXPECT_GT(static_cast<double>(run.snapshot().tick), planned_s * 480 + 1);  // it waited
}

TEST(ScriptPlayerTest, AHandThatSpringsBackWithItsThingGoesDownAgain) {
  const Scene scene = MakeScene({});
  Snapshot held = Simulation(scene, {}).snapshot();
  held.bodies[kObject].X_WB.p_m.z() += 0.2;
  held.contacts = {{.a = {.body = BodyIndex(kObject)}, .b = {.hand = HandIndex(0)}}};
  const Script script = {.stages = {One(ReachStep{"object"}, 0.01), One(PlaceStep{"table"}, 0.5)}};
  // The same, but touching the table, with the palm lower than its target by a centimetre.
  const auto touching = [&](double target_m) {
    Snapshot now = held;
    now.hands[0].palm.X_WB.p_m.z() = target_m - 0.01;
    now.contacts.insert(now.contacts.begin(), {.a = {.body = BodyIndex(kTable)},
                                               .b = {.body = BodyIndex(kObject)},
                                               .nhat_BA_W = -Eigen::Vector3d::UnitZ(),
                                               .normal_impulse_n_s = 1});
    return now;
  };
  ScriptPlayer undisturbed(scene, script), stays(scene, script), springs_back(scene, script);
  double target_m = 0;
  for (int i = 0; i < 5 + 120; ++i) {
    target_m = undisturbed.Advance(held)->front().target.X_WH.p_m.z();
    stays.Advance(held);
    springs_back.Advance(held);
  }
  const Snapshot landed = touching(target_m);
  const double next_m = undisturbed.Advance(held)->front().target.X_WH.p_m.z();
  EXPECT_EQ(stays.Advance(landed)->front().target.X_WH.p_m.z(), next_m);
  EXPECT_EQ(springs_back.Advance(landed)->front().target.X_WH.p_m.z(), next_m);
  const double after_m = undisturbed.Advance(held)->front().target.X_WH.p_m.z();
  ASSERT_GT(after_m, target_m - 0.01);
  EXPECT_EQ(stays.Advance(landed)->front().target.X_WH.p_m.z(), after_m);
  EXPECT_EQ(springs_back.Advance(held)->front().target.X_WH.p_m.z(), target_m - 0.01);
}

TEST(ScriptPlayerTest, WhatCannotBePutDownNamesTheStep) {
  // The world does not move: the hand is stuck with the object.
  const Scene scene = MakeScene({});
  Snapshot stuck = Simulation(scene, {}).snapshot();
  stuck.bodies[kObject].X_WB.p_m.z() += 0.2;
  stuck.contacts = {{.a = {.body = BodyIndex(kObject)}, .b = {.hand = HandIndex(0)}}};
  ScriptStage place = One(PlaceStep{"table"}, 0.5);
  place.steps[0].written_at = "milk.yaml:12:5";
  ScriptPlayer player(scene, {.stages = {One(ReachStep{"object"}, 0.01), place}});
  int ticks = 0;
  while (player.Advance(stuck)) ++ticks;
  EXPECT_EQ(player.problem(),
            "milk.yaml:12:5: place_on: 'object' does not stand on 'table', but is held 200 mm "
            "above it");
  EXPECT_EQ(ticks, 5 + 240 + 480);  // it waited for a second
}

}  // namespace
}  // namespace prehend::physics
