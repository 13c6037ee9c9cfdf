// SPDX-License-Identifier: Apache-2.0
// A person and fixed things: what touches is a contact, what yields stops before it, and what goes
// in is noted.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "physics/person/gaze.h"
#include "physics/person/skeleton.h"
#include "physics/simulation.h"

namespace prehend::physics {
namespace {

/// A floor, a wall whose near face is at `wall_m` ahead, and a person at the origin.
Scene Room(double wall_m, double thick_m = 0.1) {
  Scene scene;
  const auto add = [&](const char* name, const Eigen::Vector3d& size_m,
                       const Eigen::Vector3d& p_m) {
    Body body{.name = name, .fixed = true};
    body.shapes.push_back({Box{size_m}, {}});
    body.X_WB.p_m = p_m;
    scene.bodies.push_back(body);
  };
  add("floor", {8, 8, 0.1}, {0, 0, -0.05});
  add("wall", {thick_m, 3, 2.2}, {wall_m + thick_m / 2, 0, 1.1});
  Person anna{.name = "anna", .head = BodyIndex(2), .has_body = true};
  for (const Body& part : PartsOf(anna)) scene.bodies.push_back(part);
  const std::vector<Pose> places = PlacesOf(anna, Standing(scene, anna), {});
  for (std::size_t i = 0; i < places.size(); ++i) scene.bodies[2 + i].X_WB = places[i];
  scene.persons.push_back(anna);
  return scene;
}

Script Of(PersonAction action, double over_s) {
  Script script;
  script.stages.push_back({.steps = {}, .person_steps = {{0, std::move(action), over_s}}});
  return script;
}

struct Walked {
  double farthest_m = -1;  ///< of any part's centre, along x
  double deepest_m = -1;   ///< in the wall
  std::set<std::string> touching;
  std::vector<std::string> notes;
  bool completed = false;
};
Walked Play(const Scene& scene, const Script& script) {
  Simulation simulation(scene, script);
  Walked walked;
  while (simulation.Step()) {
    const Snapshot& now = simulation.snapshot();
    for (std::size_t i = 2; i < scene.bodies.size(); ++i)
      walked.farthest_m = std::max(walked.farthest_m, now.bodies[i].X_WB.p_m.x());
    for (const ContactPoint& contact : now.contacts) {
      walked.deepest_m = std::max(walked.deepest_m, -contact.distance_m);
      walked.touching.insert(scene.body(contact.a.body).name);
      walked.touching.insert(scene.body(contact.b.body).name);
    }
  }
  walked.completed = simulation.status().kind == RunStatus::Kind::kCompleted;
  for (const ScriptNote& note : simulation.notes()) walked.notes.push_back(note.text);
  return walked;
}

TEST(FixedThings, WhoStandsOnTheFloorTouchesNothing) {
  const Walked walked = Play(Room(1), Of(WaitStep{}, 0.2));
  EXPECT_TRUE(walked.touching.empty());
  EXPECT_TRUE(walked.notes.empty());
}

TEST(FixedThings, AWalkThroughAWallIsAContactAndANote) {
  for (const double wall_m : {0.5, 0.95}) {
    const Walked walked = Play(Room(wall_m), Of(WalkStep{.to_m = {2, 0}}, 3));
    EXPECT_TRUE(walked.completed);
    EXPECT_TRUE(walked.touching.contains("wall"));
    EXPECT_FALSE(walked.touching.contains("floor"));
    ASSERT_EQ(walked.notes.size(), 1u);
    EXPECT_NE(walked.notes[0].find(" into wall, which is fixed, and comes out on another side of "
                                   "it; walking, and a limb that moves, stop"),
              std::string::npos)
        << walked.notes[0];
  }
}

TEST(FixedThings, AWalkWithALimitStopsBeforeAWall) {
  for (const double force_n : {1.0, 200.0}) {
    for (const double wall_m : {0.4, 1.6}) {
      for (const double over_s : {0.4, 0.5, 0.6, 0.8, 4.0}) {
        const Walked walked =
            Play(Room(wall_m), Of(WalkStep{.to_m = {2, 0}, .max_force_n = force_n}, over_s));
        EXPECT_TRUE(walked.completed);
        EXPECT_TRUE(walked.notes.empty());
        EXPECT_TRUE(walked.touching.contains("wall")) << wall_m << " m in " << over_s << " s";
        EXPECT_LT(walked.deepest_m, 1e-4);
        EXPECT_LT(walked.farthest_m, wall_m);
      }
    }
  }
}

TEST(FixedThings, ALimbWithALimitStopsBeforeAWall) {
  for (const LimbEnd limb :
       {LimbEnd::kRightFoot, LimbEnd::kLeftFoot, LimbEnd::kRightWrist, LimbEnd::kLeftElbow}) {
    const bool is_foot = LimbOf(limb) >= 2;
    const Eigen::Vector3d to_m(0.5, LimbOf(limb) % 2 == 0 ? -0.1 : 0.1, is_foot ? 0.4 : 1.2);
    const MoveLimbStep free{.limb = limb, .to_m = to_m};
    const Walked through = Play(Room(0.3, 0.04), Of(free, 1));
    EXPECT_TRUE(through.touching.contains("wall")) << static_cast<int>(limb);
    EXPECT_FALSE(through.notes.empty());
    MoveLimbStep yielding = free;
    yielding.max_force_n = 30;
    const Walked stopped = Play(Room(0.3, 0.04), Of(yielding, 1));
    EXPECT_LT(stopped.deepest_m, 1e-4) << static_cast<int>(limb);
    EXPECT_TRUE(stopped.touching.contains("wall"));
    for (const std::string& note : stopped.notes)
      EXPECT_EQ(note.find("which is fixed"), std::string::npos) << note;
  }
}

/// A rug and a board to stand on are no obstacles, a kerb is one.
TEST(FixedThings, FeetGoOverWhatTheyStandOn) {
  for (const double high_m : {0.01, 0.02, 0.2}) {
    Scene scene = Room(3);
    scene.bodies[1].shapes.front().shape = Box{{1, 1, high_m}};
    scene.bodies[1].X_WB.p_m = {1, 0, high_m / 2};
    const Walked walked = Play(scene, Of(WalkStep{.to_m = {1, 0}, .max_force_n = 100}, 2));
    EXPECT_EQ(walked.touching.contains("wall"), high_m > 0.1) << high_m;
    EXPECT_EQ(walked.farthest_m > 0.9, high_m < 0.1) << high_m;
  }
}

}  // namespace
}  // namespace prehend::physics
