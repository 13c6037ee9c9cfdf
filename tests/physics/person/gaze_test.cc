// SPDX-License-Identifier: Apache-2.0
// Where persons look, what they see, and how they move: physics/person/gaze.h,
// physics/person/person_player.h.
#include "physics/person/gaze.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "physics/person/skeleton.h"
#include "tests/physics/tabletop.h"

namespace prehend::physics {
namespace {

using Eigen::Vector3d;

/// The tabletop and, behind it at x = -0.7, a head that faces it.
Scene WithPerson(Eyes eyes = Eyes::kAhead) {
  Scene scene = MakeScene({});
  Person person{.name = "anna",
                .head = BodyIndex(scene.bodies.size()),
                .X_WS = {{-0.7, 0, 0}},
                .eyes = eyes,
                .right_hand = HandIndex(0)};
  for (Body& part : PartsOf(person)) scene.bodies.push_back(part);
  scene.bodies.back().X_WB = PlacesOf(person, Standing(scene, person), {}).front();
  scene.persons.push_back(person);
  return scene;
}

Script Told(PersonAction action, double over_s = 1) {
  Script script;
  script.stages.push_back({.steps = {}, .person_steps = {{0, std::move(action), over_s}}});
  script.settle_s = 0;
  return script;
}

std::vector<GazeState> GazesOf(const Scene& scene, const Script& script) {
  Simulation simulation(scene, script);
  std::vector<GazeState> gazes = {simulation.snapshot().gazes.at(0)};
  while (simulation.Step()) gazes.push_back(simulation.snapshot().gazes.at(0));
  EXPECT_EQ(simulation.status().kind, RunStatus::Kind::kCompleted) << simulation.status().reason;
  return gazes;
}

TEST(GazeTest, AheadThereIsNothing) {
  const auto gazes = GazesOf(WithPerson(), Told(WaitStep{}, 0.1));
  EXPECT_LT((gazes.back().toward_W - Vector3d::UnitX()).norm(), 1e-9);
  EXPECT_EQ(gazes.back().body, kNone);
}

TEST(GazeTest, SheSeesWhatSheLooksAt) {
  const auto gazes = GazesOf(WithPerson(), Told(LookAtStep{"object"}));
  EXPECT_EQ(gazes.back().body, BodyIndex(kObject));
  EXPECT_NEAR(gazes.back().distance_m, 1.1, 0.15);
  EXPECT_EQ(GazesOf(WithPerson(), Told(LookAtStep{Vector3d(0.4, -0.2, kTop_m)})).back().body,
            BodyIndex(kTable));
  const auto at_hand = GazesOf(WithPerson(), Told(LookAtStep{"hand"}));
  EXPECT_EQ(at_hand.back().hand, HandIndex(0));
  EXPECT_EQ(at_hand.back().body, kNone);
}

TEST(GazeTest, WhatStandsBeforeItHidesIt) {
  Scene scene = WithPerson();
  scene.bodies[kTable].X_WB.p_m.z() = 1.3;  // its underside now hides what stands below
  scene.bodies[kObject].X_WB.p_m.z() = 0.1;
  scene.bodies[kObject].fixed = true;
  scene.bodies[kObject].X_WB.p_m.x() = 0;
  EXPECT_EQ(GazesOf(scene, Told(LookAtStep{"object"})).back().body, BodyIndex(kTable));
}

TEST(GazeTest, ASaccadeIsFasterThanTheHead) {
  EyesAndHead gaze(Vector3d::UnitX());
  const Vector3d there = Vector3d::UnitY();  // 90 degrees: 219 ms
  double eyes_s = 0;
  int ticks = 0;
  for (; ticks < 480; ++ticks) {
    gaze.Turn(there, 1.0 / 480);
    if (eyes_s == 0 && (gaze.eyes_W() - there).norm() < 1e-3) eyes_s = (ticks + 1) / 480.0;
    if (ticks == 48) {
      EXPECT_GT((gaze.head_W() - there).norm(), (gaze.eyes_W() - there).norm());
    }
  }
  EXPECT_NEAR(eyes_s, 0.021 + 90 * 0.0022, 0.02);
  EXPECT_LT((gaze.head_W() - there).norm(), 0.02);
}

TEST(GazeTest, AMovingTargetIsFollowedWithoutLag) {
  EyesAndHead gaze(Vector3d::UnitX());
  for (int tick = 1; tick < 480; ++tick) {
    const double angle = tick / 480.0;
    const Vector3d there(std::cos(angle), std::sin(angle), 0);
    gaze.Turn(there, 1.0 / 480);
    ASSERT_LT((gaze.eyes_W() - there).norm(), 1e-9) << tick;
  }
}

/// How far her head turns in a tick at most, degrees, while she looks along these ways in turn.
double FastestOf(EyesAndHead& gaze, const std::function<Vector3d(int)>& way, int ticks) {
  const auto facing = [&] { return HeadToward(Person{}, Vector3d::Zero(), gaze.head_W()).q; };
  double fastest_rad = 0;
  for (int tick = 0; tick < ticks; ++tick) {
    const Eigen::Quaterniond before = facing();
    gaze.Turn(way(tick).normalized(), 1.0 / 480);
    fastest_rad = std::max(fastest_rad, facing().angularDistance(before));
  }
  return fastest_rad * 480 * 180 / std::numbers::pi;
}

TEST(GazeTest, WhatIsBehindIsLookedAtOverAShoulder) {
  for (const double left_m : {0.0, -0.0, 1e-3, -1e-3, 0.026, -0.026}) {
    EyesAndHead gaze(Vector3d::UnitX());
    double lowest = 1, highest = -1, side = 0;
    const double fastest = FastestOf(
        gaze,
        [&](int) {
          lowest = std::min({lowest, gaze.eyes_W().z(), gaze.head_W().z()});
          highest = std::max({highest, gaze.eyes_W().z(), gaze.head_W().z()});
          side += gaze.head_W().y();
          return Vector3d(-3, left_m, -0.1);
        },
        960);
    EXPECT_GT(lowest, -0.05) << left_m;  // the shortest way of 90 degrees goes below both ends
    EXPECT_LT(highest, 1e-9) << left_m;
    EXPECT_GT(left_m < 0 ? -side : side, 0) << left_m << ": the shorter way, or to the left";
    EXPECT_LE(fastest, 600.1) << left_m;
    EXPECT_LT((gaze.head_W() - gaze.eyes_W()).norm(), 1e-3) << left_m;
  }
}

TEST(GazeTest, AHeadDoesNotWhirlAroundWhatPassesBelowOrAbove) {
  for (const double up_m : {-1.4, -0.1, 0.0, 0.5}) {
    for (const double left_m : {0.0, 0.002, 0.03, 0.05}) {
      EyesAndHead gaze(Vector3d::UnitX());
      const auto way = [&](int tick) { return Vector3d(1 - tick / 480.0, left_m, up_m + 1e-9); };
      EXPECT_LE(FastestOf(gaze, way, 1440), 600 * std::sqrt(2) + 0.1) << up_m << " " << left_m;
      EXPECT_GT(gaze.eyes_W().dot(way(1440).normalized()), 0.999);
    }
  }
}

TEST(GazeTest, AHeadKeepsItsYawStraightAboveAThing) {
  EyesAndHead gaze(Vector3d::UnitY());
  const auto below = [](int tick) { return Vector3d(1e-3 * (tick % 2), -1e-3, -1); };
  FastestOf(gaze, below, 960);
  EXPECT_NEAR(gaze.head_W().x(), 0, 1e-3);
  EXPECT_GT(gaze.head_W().y(), 0.1);
}

/// First tick at which she sees this body; -1: never.
int FirstSeen(const std::vector<GazeState>& gazes, std::size_t body) {
  for (std::size_t i = 0; i < gazes.size(); ++i) {
    if (gazes[i].body == BodyIndex(body)) return static_cast<int>(i);
  }
  return -1;
}

TEST(GazeTest, EyesLeadTheHand) {
  const Scene scene = WithPerson(Eyes::kLead);
  Simulation simulation(scene, MakeScript({}));
  int touched = -1, seen = -1, saw_table = -1, carry_ends = static_cast<int>(480 * 3.0);
  while (simulation.Step()) {
    const Snapshot& now = simulation.snapshot();
    const int tick = static_cast<int>(now.tick);
    for (const ContactPoint& contact : now.contacts) {
      if (touched < 0 && (contact.a.hand != kNone) != (contact.b.hand != kNone)) touched = tick;
    }
    if (seen < 0 && now.gazes[0].body == BodyIndex(kObject)) seen = tick;
    if (seen >= 0 && tick > 480 * 2.0 && saw_table < 0 && now.gazes[0].body == BodyIndex(kTable))
      saw_table = tick;
  }
  ASSERT_EQ(simulation.status().kind, RunStatus::Kind::kCompleted) << simulation.status().reason;
  EXPECT_GT(seen, 0);
  EXPECT_LT(seen, touched - 480 * 0.3) << "the eyes are there well before the hand";
  EXPECT_GT(saw_table, 0);
  EXPECT_LT(saw_table, carry_ends) << "and at the landing place before the object";
}

TEST(GazeTest, ToldGoesBeforeOwnWishes) {
  Script script = MakeScript({});
  script.stages[0].person_steps.push_back({0, LookAtStep{Vector3d(0.4, -0.3, kTop_m)}, 0.1});
  script.stages[1].person_steps.push_back({0, EyesStep{Eyes::kLead}, 0.1});
  const auto gazes = GazesOf(WithPerson(Eyes::kLead), script);
  const int seen = FirstSeen(gazes, kObject);
  EXPECT_GE(seen, static_cast<int>(0.8 * 480));
}

TEST(GazeTest, ARecordedHeadLooksWhereItFaces) {
  const Eigen::Quaterniond down(Eigen::AngleAxisd(0.6, Vector3d::UnitY()));
  const HeadPosesStep recorded{{{.t_s = 0.5, .X_WH = {{-0.6, -0.35, 1.5}, down}, .trigger = {}},
                                {.t_s = 1.0, .X_WH = {{-0.6, -0.35, 1.5}, down}, .trigger = {}}}};
  const auto gazes = GazesOf(WithPerson(), Told(recorded));
  EXPECT_LT((gazes.back().toward_W - down * Vector3d::UnitX()).norm(), 1e-6);
  EXPECT_EQ(gazes.back().body, BodyIndex(kTable));
}

TEST(GazeTest, TheGazeIsInTheStateHash) {
  const auto hash = [](const Script& script) {
    Simulation simulation(WithPerson(), script);
    while (simulation.Step()) {
    }
    return simulation.state_hash();
  };
  EXPECT_EQ(hash(Told(LookAtStep{"object"})), hash(Told(LookAtStep{"object"})));
  EXPECT_NE(hash(Told(LookAtStep{"object"})), hash(Told(WaitStep{})));
}

}  // namespace
}  // namespace prehend::physics
