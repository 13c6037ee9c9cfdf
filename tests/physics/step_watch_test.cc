// SPDX-License-Identifier: Apache-2.0
// Steps that do not achieve what they say are noted, with numbers.
#include "physics/step_watch.h"

#include <gtest/gtest.h>

#include "tests/physics/tabletop.h"

namespace prehend::physics {
namespace {

using Eigen::Vector3d;
using Texts = std::vector<std::string>;

Texts NotesOf(const Scene& scene, const Script& script) {
  Simulation simulation(scene, script);
  while (simulation.Step()) {
  }
  EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kCompleted) << simulation.status().reason;
  Texts texts;
  for (const ScriptNote& note : simulation.notes()) {
    // Anna stands so near that her left hand hangs in the table; where she moves it may go deeper.
    if (note.text.starts_with("anna_left_hand starts 51 mm in table, which is fixed") ||
        note.text.starts_with("anna_left_hand goes 51 mm into table, which is fixed"))
      continue;
    texts.push_back((note.hand == kNone ? "" : scene.hand(note.hand).name + ": ") + note.text);
  }
  return texts;
}

ScriptStage One(StepAction action, double over_s) {
  return {{{HandIndex(0), std::move(action), over_s}}};
}

/// The object slides along x, away from the hand.
Scene OnASlider() {
  Scene scene = MakeScene({});
  scene.joints.push_back({.kind = JointKind::kSlider,
                          .body = BodyIndex(kObject),
                          .base = BodyIndex(kTable),
                          .axis_W = Vector3d::UnitX(),
                          .lower = 0,
                          .upper = 0.2});
  return scene;
}

TEST(StepWatch, AJointThatNothingLeadsIsNoted) {
  EXPECT_EQ(NotesOf(OnASlider(), {.stages = {One(FollowJointStep{"object", 1}, 0.5)}}),
            Texts{"hand: follow_joint: object is at 0 mm of its joint, not at 200 mm; it does not "
                  "touch object: reach for its handle and 'close_to: 1' first"});
}

TEST(StepWatch, AHandThatSlipsOffIsNotToldToReach) {
  Scene scene = OnASlider();
  scene.joints[0].axis_W = Vector3d::UnitZ();
  scene.joints[0].friction = 500;
  const HandIndex hand(0);
  const Script script{
      .stages = {One(ReachStep{"object"}, 0.8),
                 One(TriggerStep{1}, 0.6),
                 {{{hand, FollowJointStep{"object", 1}, 1}, {hand, TriggerStep{0}, 0.3}}}}};
  EXPECT_EQ(NotesOf(scene, script),
            Texts{"hand: follow_joint: object is at 3 mm of its joint, not at 200 mm; it has "
                  "slipped off object, which it touched on the way: take more time ('over_s'), or "
                  "another style"});
}

TEST(StepWatch, AJointThatFollowsIsNotNoted) {
  const Script script{.stages = {One(ReachStep{"object"}, 0.8), One(TriggerStep{1}, 0.6),
                                 One(FollowJointStep{"object", 1}, 1)}};
  EXPECT_EQ(NotesOf(OnASlider(), script), Texts{});
  EXPECT_EQ(NotesOf(OnASlider(), {.stages = {One(FollowJointStep{"object", 0}, 0.5)}}), Texts{})
      << "it is there already";
}

/// Somebody with a body stands before the table, facing it; the hand is her right one if `led`.
Scene WithAnna(bool led, const Vector3d& hand_at_m = {-0.2, -0.1, 1.05}) {
  Scene scene = MakeScene({.hand_at_m = hand_at_m});
  Person person{.name = "anna",
                .head = BodyIndex(scene.bodies.size()),
                .has_body = true,
                .X_WS = {{-0.65, 0, 0}},
                .eyes = Eyes::kAhead,
                .right_hand = HandIndex(led ? 0 : -1)};
  const std::vector<Pose> places = PlacesOf(person, Standing(scene, person), {});
  for (std::size_t i = 0; Body & part : PartsOf(person)) {
    part.X_WB = places[i++];
    scene.bodies.push_back(part);
  }
  scene.persons.push_back(person);
  return scene;
}

Script LimbGoes(LimbEnd limb, const Vector3d& to_m) {
  return {.stages = {{.steps = {}, .person_steps = {{0, MoveLimbStep{limb, to_m}, 0.5}}}}};
}

TEST(StepWatch, ALimbThatDoesNotGetThereIsNoted) {
  const Scene scene = WithAnna(false);
  const Texts far = NotesOf(scene, LimbGoes(LimbEnd::kLeftElbow, {0.6, 0.2, 1.2}));
  ASSERT_EQ(far.size(), 1u);
  EXPECT_TRUE(far[0].starts_with("anna: move_limb: her left_elbow ends ")) << far[0];
  EXPECT_TRUE(
      far[0].ends_with(" mm before its to_m, which is out of reach; let her stand nearer, "
                       "walk, turn or lean"))
      << far[0];
  EXPECT_EQ(NotesOf(scene, LimbGoes(LimbEnd::kLeftWrist, {-0.3, 0.2, 1.1})), Texts{});
}

TEST(StepWatch, WhoStartsInAFixedThingIsTold) {
  Scene scene = WithAnna(false);
  for (int part = 0; part < static_cast<int>(scene.bodies.size()) - 2; ++part)
    scene.bodies[static_cast<std::size_t>(part) + 2].X_WB.p_m.x() += 0.1;
  scene.persons[0].X_WS.p_m.x() += 0.1;
  Simulation simulation(scene, {.stages = {One(WaitStep{}, 0.1)}});
  while (simulation.Step()) {
  }
  Texts starts;
  for (const ScriptNote& note : simulation.notes())
    if (note.text.find(" in table, which is fixed; let her start elsewhere") != note.text.npos)
      starts.push_back(note.text);
  ASSERT_EQ(starts.size(), 1u);
  EXPECT_TRUE(starts[0].starts_with("anna_")) << starts[0];
}

TEST(StepWatch, AnArmThatIsTooShortIsNoted) {
  const Texts far = NotesOf(WithAnna(true), {.stages = {One(MoveStep{{0.6, 0, 0}}, 1)}});
  ASSERT_EQ(far.size(), 1u);
  EXPECT_TRUE(far[0].starts_with("hand: it is out of reach: the arm of anna ends ")) << far[0];
}

TEST(StepWatch, AnArmThatPushesSomethingOnItsWayIsNoted) {
  const auto met_by_the_arm = [](double object_y_m) {
    Scene scene = WithAnna(true, {-0.25, -0.25, 0.95});
    scene.bodies[kObject].shapes = {{Box{{0.07, 0.07, 0.4}}, {}}};
    scene.bodies[kObject].X_WB.p_m = {-0.42, object_y_m, kTop_m + 0.2};
    Texts met;
    for (const std::string& note : NotesOf(scene, {.stages = {One(MoveStep{{0, 0.25, 0}}, 1)}}))
      if (note.find("on its way") != std::string::npos) met.push_back(note);
    return met;
  };
  const Texts notes = met_by_the_arm(-0.08);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_TRUE(
      notes[0].starts_with("hand: on its way anna_right_forearm touches object and moves it by "))
      << notes[0];
  EXPECT_TRUE(notes[0].ends_with(" mm; let her stand elsewhere, go another way, or make room"))
      << notes[0];
  EXPECT_EQ(met_by_the_arm(0.35), Texts{}) << "out of its way";
}

}  // namespace
}  // namespace prehend::physics
