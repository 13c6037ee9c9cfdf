// SPDX-License-Identifier: Apache-2.0
// Persons move as they are told, and push what can move.
#include "physics/person/person_player.h"

#include <gtest/gtest.h>

#include "physics/simulation.h"
#include "tests/physics/library_hand.h"

namespace prehend::physics {
namespace {

using Eigen::Vector3d;

/// A body that stands at the origin and faces x; a block of 2 kg on a low table before it.
constexpr int kTable = 0, kBlock = 1, kHead = 2;
Scene Before(const Vector3d& block_at_m) {
  Scene scene;
  const double top = block_at_m.z() - 0.1;
  scene.bodies.push_back({.name = "table",
                          .shapes = {PlacedShape{Box{{1, 1, 0.04}}, {}}},
                          .fixed = true,
                          .X_WB = {{0.75, 0, top - 0.02}}});
  scene.bodies.push_back({.name = "block",
                          .shapes = {PlacedShape{Box{{0.2, 0.2, 0.2}}, {}}},
                          .mass_kg = 2,
                          .friction = 0.4,
                          .X_WB = {block_at_m}});
  Person person{.name = "anna", .head = BodyIndex(kHead), .has_body = true, .eyes = Eyes::kAhead};
  const std::vector<Pose> places = PlacesOf(person, Standing(scene, person), {});
  for (Body& part : PartsOf(person)) {
    part.X_WB = places[scene.bodies.size() - kHead];
    scene.bodies.push_back(part);
  }
  scene.persons.push_back(person);
  return scene;
}

int PartNamed(const Scene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

struct Played {
  Snapshot end;
  std::uint64_t hash = 0;
  bool touched = false;  ///< the block by this part
};
Played Play(const Scene& scene, std::vector<PersonStep> steps, const std::string& part = "",
            double settle_s = 0.3) {
  Script script;
  script.settle_s = settle_s;
  for (PersonStep& step : steps) script.stages.push_back({.steps = {}, .person_steps = {step}});
  Simulation simulation(scene, script);
  Played played;
  const int touching = PartNamed(scene, part);
  while (simulation.Step()) {
    for (const ContactPoint& contact : simulation.snapshot().contacts)
      played.touched |=
          contact.a.body == BodyIndex(kBlock) && contact.b.body == BodyIndex(touching);
  }
  EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kCompleted) << simulation.status().reason;
  played.end = simulation.snapshot();
  played.hash = simulation.state_hash();
  return played;
}

/// The right foot is lifted, then goes there.
std::vector<PersonStep> Kick(const Vector3d& there) {
  const Vector3d lifted(0.05, there.y(), there.z());
  return {{0, MoveLimbStep{LimbEnd::kRightFoot, lifted}, 0.5},
          {0, MoveLimbStep{LimbEnd::kRightFoot, there}, 0.8}};
}

TEST(PersonPlayerTest, AFootPushesABlockAndStaysWhereItIsSent) {
  const Scene scene = Before({0.45, -0.09, 0.4});
  const Vector3d there(0.35, -0.09, 0.4);
  const Played played = Play(scene, Kick(there), "anna_right_toes");
  EXPECT_TRUE(played.touched);
  EXPECT_GT(played.end.bodies[kBlock].X_WB.p_m.x(), 0.55);
  const Pose& foot =
      played.end.bodies[static_cast<std::size_t>(PartNamed(scene, "anna_right_foot"))].X_WB;
  EXPECT_LT((foot.p_m - there).norm(), 0.02);
}

TEST(PersonPlayerTest, ALimbGoesBack) {
  const Scene scene = Before({0.6, 0.3, 0.4});
  const Played played =
      Play(scene, {{0, MoveLimbStep{LimbEnd::kRightFoot, Vector3d(0.3, -0.09, 0.4)}, 0.6},
                   {0, MoveLimbStep{LimbEnd::kRightFoot, std::nullopt}, 0.6}});
  const auto foot = static_cast<std::size_t>(PartNamed(scene, "anna_right_foot"));
  EXPECT_LT((played.end.bodies[foot].X_WB.p_m - scene.bodies[foot].X_WB.p_m).norm(), 1e-6);
}

TEST(PersonPlayerTest, WalkingTurningAndLeaningMoveThePelvisAndTheHead) {
  const Scene scene = Before({0.9, 0.3, 0.4});
  const auto pelvis = static_cast<std::size_t>(PartNamed(scene, "anna_pelvis"));
  const Snapshot walked = Play(scene, {{0, WalkStep{{-0.5, 0.25}}, 0.6}}).end;
  EXPECT_LT(
      (walked.bodies[pelvis].X_WB.p_m - scene.bodies[pelvis].X_WB.p_m - Vector3d(-0.5, 0.25, 0))
          .norm(),
      1e-6);
  const Snapshot turned = Play(scene, {{0, TurnStep{1.5708}, 0.6}}).end;
  EXPECT_GT((turned.bodies[kHead].X_WB.q * Vector3d::UnitX()).y(), 0.9);
  const Snapshot leaned = Play(scene, {{0, LeanStep{0.5}, 0.6}}).end;
  EXPECT_GT(leaned.bodies[kHead].X_WB.p_m.x(), 0.25);
}

TEST(PersonPlayerTest, NothingPushesHer) {
  Scene scene = Before({0.45, -0.09, 0.4});
  scene.bodies[kBlock].mass_kg = 500;
  scene.bodies[kBlock].friction = 0.05;
  const Vector3d there(0.35, -0.09, 0.4);
  const Played played = Play(scene, Kick(there));
  const auto foot = static_cast<std::size_t>(PartNamed(scene, "anna_right_foot"));
  EXPECT_LT((played.end.bodies[foot].X_WB.p_m - there).norm(), 0.02);
}

/// How deep the toes stand in the block at the end, metres.
double DepthIn(const Played& played, const Scene& scene) {
  const Pose& toes =
      played.end.bodies[static_cast<std::size_t>(PartNamed(scene, "anna_right_toes"))].X_WB;
  const auto& capsule = std::get<Capsule>(
      scene.bodies[static_cast<std::size_t>(PartNamed(scene, "anna_right_toes"))].shapes[0].shape);
  const double tip = std::max((toes * Vector3d(0, 0, capsule.length_m / 2)).x(),
                              (toes * Vector3d(0, 0, -capsule.length_m / 2)).x()) +
                     capsule.radius_m;
  return tip - (played.end.bodies[kBlock].X_WB.p_m.x() - 0.1);
}

TEST(PersonPlayerTest, ALimbYieldsToWhatResistsMoreThanItMayPush) {
  Scene scene = Before({0.45, -0.09, 0.4});
  scene.bodies[kBlock].mass_kg = 60;
  scene.bodies[kBlock].friction = 2;  // 60 kg * 9.81 * 2 * 0.8: it takes some 940 N to slide it
  const Vector3d there(0.33, -0.09, 0.4);
  std::vector<PersonStep> steps = Kick(there);
  std::get<MoveLimbStep>(steps[1].action).max_force_n = 60;
  const Played yielding = Play(scene, steps);
  // The first blow has the speed of the limb.
  EXPECT_LT(std::abs(yielding.end.bodies[kBlock].X_WB.p_m.x() - 0.45), 0.03);
  EXPECT_LT(DepthIn(yielding, scene), 0.004);
  // One that does not yield moves the same block.
  EXPECT_GT(Play(scene, Kick(there)).end.bodies[kBlock].X_WB.p_m.x(), 0.5);
}

TEST(PersonPlayerTest, ALimbThatMayYieldStillPushesWhatIsLight) {
  const Scene scene = Before({0.45, -0.09, 0.4});
  std::vector<PersonStep> steps = Kick({0.35, -0.09, 0.4});
  std::get<MoveLimbStep>(steps[1].action).max_force_n = 60;
  EXPECT_GT(Play(scene, steps).end.bodies[kBlock].X_WB.p_m.x(), 0.52);
}

TEST(PersonPlayerTest, AWalkYieldsToWhatResistsMoreThanItMayPush) {
  // A block as high as her hips, in front of them, on the floor.
  Scene scene = Before({0.4, 0, 0.1});
  scene.bodies[kBlock].shapes.front().shape = Box{{0.2, 0.4, 1}};
  scene.bodies[kBlock].X_WB.p_m.z() = 0.5;
  scene.bodies[kBlock].mass_kg = 60;
  scene.bodies[kBlock].friction = 2;
  const auto walk = [&](std::optional<double> max_force_n, double settle_s = 0.3) {
    const Played played = Play(scene, {{0, WalkStep{{0.4, 0}, max_force_n}, 1.5}}, "", settle_s);
    return played.end.bodies[kBlock].X_WB.p_m.x();
  };
  EXPECT_LT(walk(60) - 0.4, 0.03) << "the first blow has her speed";
  for (const double force_n : {1.0, 60.0})
    EXPECT_LT(walk(force_n, 10) - walk(force_n), 0.0002)
        << "then it stays, however long she pushes";
  EXPECT_GT(walk(std::nullopt) - 0.4, 0.1);
  scene.bodies[kBlock].mass_kg = 1;
  scene.bodies[kBlock].friction = 0.3;
  EXPECT_GT(walk(60) - 0.4, 0.1) << "what is light is pushed";
}

TEST(PersonPlayerTest, ARecordedPostureIsTakenAndLeft) {
  const Scene scene = Before({2, 2, 0.4});
  const Person& anna = scene.persons.front();
  BodyTargets kneeling = Standing(scene, anna);
  Posture posture = PostureOf(anna, kneeling);
  posture.hips_W_m += Vector3d(0.4, 0, -0.2);
  posture.directions_W[Posture::kThigh] = Vector3d(0.8, 0, -0.6);
  const PersonStep recorded{0, BodyPosesStep{{{0.4, posture}, {0.8, posture}}}, 0.8};
  const auto pelvis = static_cast<std::size_t>(PartNamed(scene, "anna_pelvis"));
  const Snapshot held = Play(scene, {recorded}).end;
  EXPECT_LT((held.bodies[pelvis].X_WB.p_m - posture.hips_W_m).norm(), 1e-9);
  const auto thigh = static_cast<std::size_t>(PartNamed(scene, "anna_right_thigh"));
  EXPECT_NEAR(std::abs((held.bodies[thigh].X_WB.q * Vector3d::UnitZ()).x()), 0.8, 1e-6);
  // Afterwards she stands where her hips are.
  const Snapshot left = Play(scene, {recorded, {0, WaitStep{}, 0.5}}).end;
  EXPECT_LT(
      (left.bodies[pelvis].X_WB.p_m - scene.bodies[pelvis].X_WB.p_m - Vector3d(0.4, 0, 0)).norm(),
      1e-6);
}

/// A head that is recorded at these places, each half a second after the one before.
PersonStep RecordedHead(const std::vector<Vector3d>& places_m, double first_s) {
  HeadPosesStep step;
  for (const Vector3d& at_m : places_m) {
    const double t_s = first_s + 0.5 * static_cast<double>(step.poses.size());
    step.poses.push_back({.t_s = t_s, .X_WH = {at_m}, .trigger = {}});
  }
  return {0, step, step.poses.back().t_s};
}

TEST(PersonPlayerTest, AfterARecordingOfItTheHeadGoesBackWithinTheNextStep) {
  Scene scene = Before({2, 2, 0.4});
  const PersonStep recorded = RecordedHead({{0.2, 0.1, 1.4}, {0.6, 0.3, 1.2}}, 0.5);
  const auto fastest = [&](const std::vector<PersonStep>& steps) {
    Script script;
    for (const PersonStep& step : steps) script.stages.push_back({{}, {step}});
    Simulation simulation(scene, script);
    double most_m_per_s = 0;
    while (simulation.Step())
      most_m_per_s =
          std::max(most_m_per_s, simulation.snapshot().body(BodyIndex(kHead)).v_WB_m_per_s.norm());
    EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kCompleted) << simulation.status().reason;
    return most_m_per_s;
  };
  const std::vector<PersonStep> wait = {recorded, {0, WaitStep{}, 0.5}};
  const Vector3d at_first = scene.bodies[kHead].X_WB.p_m;
  const auto end = [&] { return Play(scene, wait).end.body(BodyIndex(kHead)).X_WB.p_m; };
  EXPECT_LT(fastest(wait), 5);
  EXPECT_LT((end() - at_first).norm(), 1e-6) << "on its neck";
  const PersonStep body{
      0, BodyPosesStep{{{0.4, PostureOf(scene.persons[0], Standing(scene, scene.persons[0]))}}},
      0.4};
  EXPECT_LT(fastest({recorded, body}), 6);
  // A head alone stays where it was recorded: she stands below.
  scene.persons.front().has_body = false;
  scene.bodies.resize(kHead + 1);
  EXPECT_LT(fastest(wait), 2);
  EXPECT_LT((end() - Vector3d(0.6, 0.3, at_first.z())).norm(), 1e-6);
}

TEST(PersonPlayerTest, ARecordingThatJoinsAtOnceJumpsWithoutSpeed) {
  const Scene scene = Before({2, 2, 0.4});
  Posture there = PostureOf(scene.persons[0], Standing(scene, scene.persons[0]));
  there.hips_W_m += Vector3d(1, 1, 0);
  for (const PersonStep& jump : {PersonStep{0, BodyPosesStep{{{0, there}, {0.5, there}}}, 0.5},
                                 RecordedHead({{1, 1, 1.5}, {1, 1, 1.5}}, 0)}) {
    Script script;
    script.stages = {{{}, {{0, WaitStep{}, 0.1}}}, {{}, {jump}}};
    Simulation simulation(scene, script);
    while (simulation.Step())
      for (std::size_t i = kHead; i < scene.bodies.size(); ++i)
        ASSERT_LT(simulation.snapshot().bodies[i].v_WB_m_per_s.norm(), 1e-6)
            << scene.bodies[i].name;
    EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kCompleted) << simulation.status().reason;
    const Vector3d at_m = simulation.snapshot().body(BodyIndex(kHead)).X_WB.p_m;
    EXPECT_LT((at_m - Vector3d(1, 1, at_m.z())).norm(), 0.1);
  }
}

/// Counts the bodies that jump.
struct CountingWorld : World {
  void Step(const std::vector<HandCommand>&) override {}
  void Describe(Snapshot&) const override {}
  void MoveKinematic(BodyIndex, const Pose&, bool jumps) override { jumped += jumps ? 1 : 0; }
  std::size_t jumped = 0;
};

TEST(PersonPlayerTest, AHeadThatJumpsStopsNoOtherPart) {
  const Scene scene = Before({2, 2, 0.4});
  const Posture there = PostureOf(scene.persons[0], Standing(scene, scene.persons[0]));
  const auto jumped = [&](const PersonStep& step) {
    Script script;
    script.stages = {{{}, {step}}};
    PersonPlayer player(scene, script, 0);
    Snapshot now;
    now.bodies.resize(scene.bodies.size());
    player.Begin(0, {}, {0}, now);
    CountingWorld world;
    player.Advance(now, world);
    const std::size_t first = world.jumped;
    player.Advance(now, world);
    EXPECT_EQ(world.jumped, first);
    return first;
  };
  EXPECT_EQ(jumped(RecordedHead({{1, 1, 1.5}, {1, 1, 1.5}}, 0)), 1u);
  EXPECT_EQ(jumped(RecordedHead({{1, 1, 1.5}, {1, 1, 1.5}}, 0.1)), 0u);
  EXPECT_EQ(jumped({0, BodyPosesStep{{{0, there}, {0.5, there}}}, 0.5}),
            scene.bodies.size() - kHead);
}

TEST(PersonPlayerTest, AHeadThatIsRecordedFarFromItsNeckIsNoted) {
  const Scene scene = Before({2, 2, 0.4});
  Script script;
  script.stages = {{{}, {RecordedHead({{0.6, 0.3, 1.2}, {0.6, 0.3, 1.2}}, 0.5)}}};
  Simulation simulation(scene, script);
  while (simulation.Step()) {
  }
  ASSERT_EQ(simulation.notes().size(), 1u);
  EXPECT_EQ(
      simulation.notes()[0].text,
      "anna: recording: her head is 800 mm from her neck, as a recorded head does not move her "
      "body: let her stand, walk or lean below it, or write 'person: head'");
}

TEST(PersonPlayerTest, TheSameStepsGiveTheSameHash) {
  const Scene scene = Before({0.45, -0.09, 0.4});
  const Vector3d there(0.35, -0.09, 0.4);
  EXPECT_EQ(Play(scene, Kick(there)).hash, Play(scene, Kick(there)).hash);
}

}  // namespace
}  // namespace prehend::physics
