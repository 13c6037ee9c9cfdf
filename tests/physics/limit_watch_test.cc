// SPDX-License-Identifier: Apache-2.0
// What an engine gets wrong is noted, with names, lengths and a remedy.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/scene/run_limits.h"
#include "physics/simulation.h"
#include "physics/step_watch.h"

namespace prehend::physics {
namespace {

Body Thing(const std::string& name, const Eigen::Vector3d& size_m, double mass_kg,
           const Eigen::Vector3d& p_m) {
  Body body{.name = name, .fixed = mass_kg == 0, .mass_kg = mass_kg};
  body.shapes.push_back({Box{size_m}, {}});
  body.X_WB.p_m = p_m;
  return body;
}

/// A knife, 0.8 m above a board of 4 mm.
Scene KnifeAbove(Engine engine) {
  Scene scene;
  scene.world.engine = engine;
  scene.world.planar = engine == Engine::kBox2d;
  scene.bodies = {Thing("floor", {4, 0.4, 0.1}, 0, {0, 0, -0.05}),
                  Thing("board", {1.2, 0.4, 0.004}, 0, {0, 0, 1}),
                  Thing("knife", {0.2, 0.02, 0.003}, 0.05, {0.2, 0, 1.802})};
  return scene;
}

struct Ended {
  std::vector<std::string> limits;
  std::vector<ScriptNote> notes;
  Snapshot end;
  RunStatus::Kind status;
};
Ended Play(const Scene& scene, double settle_s) {
  Simulation simulation(scene, Script{.stages = {}, .settle_s = settle_s});
  while (simulation.Step()) {
  }
  Ended outcome{.limits = {},
                .notes = simulation.notes(),
                .end = simulation.snapshot(),
                .status = simulation.status().kind};
  for (const ScriptNote& note : outcome.notes) outcome.limits.push_back(LimitOf(note.text));
  return outcome;
}

TEST(LimitWatch, NotesWhatGoesThrough) {
  for (const Engine engine : {Engine::kBulletStock, Engine::kBox2d}) {
    const Ended outcome = Play(KnifeAbove(engine), 1);
    ASSERT_EQ(outcome.limits, std::vector<std::string>{"goes_through(knife, board)"});
    EXPECT_TRUE(outcome.notes[0].text.starts_with("physics: knife goes through board: it moves 8."))
        << outcome.notes[0].text;
    EXPECT_NE(outcome.notes[0].text.find("board is 4.0 mm thick; write 'world: {rate_hz: 1"),
              std::string::npos)
        << outcome.notes[0].text;
    EXPECT_NEAR(outcome.notes[0].tick, 194, 3);
  }
}

TEST(LimitWatch, NotesNothingWhereAllIsRight) {
  EXPECT_EQ(Play(KnifeAbove(Engine::kBullet), 1).limits, std::vector<std::string>());
}

TEST(LimitWatch, OtherNotesAreAboutNoLimit) {
  EXPECT_EQ(LimitOf("anna goes through wall: 3 mm"), "");
  EXPECT_EQ(LimitOf("physics: a sinks into b: 3 mm; c"), "sinks_into(a, b)");
}

/// Heavy on light: right, or noted.
TEST(LimitWatch, HeavyOnLightIsRightOrNoted) {
  int noted = 0;
  for (const double light_kg : {0.02, 0.1}) {
    for (const double heavy_kg : {1, 2, 5, 8, 10, 20}) {
      for (const Eigen::Vector3d& size_m :
           {Eigen::Vector3d(0.12, 0.12, 0.01), Eigen::Vector3d(0.05, 0.05, 0.05),
            Eigen::Vector3d(0.2, 0.2, 0.02)}) {
        Scene scene;
        const double pot_m = 0.1;
        const Eigen::Vector3d pot_W_m(0, 0, size_m.z() + pot_m / 2);
        scene.bodies = {Thing("table", {1.2, 0.8, 0.04}, 0, {0, 0, -0.02}),
                        Thing("coaster", size_m, light_kg, {0, 0, size_m.z() / 2}),
                        Thing("pot", {pot_m, pot_m, pot_m}, heavy_kg, pot_W_m)};
        const Ended outcome = Play(scene, 10);
        const Eigen::Vector3d& coaster_m = outcome.end.bodies[1].X_WB.p_m;
        const bool is_right = (outcome.end.bodies[2].X_WB.p_m - pot_W_m).norm() < 0.001 &&
                              (coaster_m - scene.bodies[1].X_WB.p_m).norm() < 0.001;
        const bool is_said = !outcome.limits.empty() || outcome.status == RunStatus::Kind::kFailed;
        EXPECT_NE(is_right, is_said)
            << heavy_kg << " kg on " << 1000 * light_kg << " g, " << 1000 * size_m.z() << " mm";
        noted += is_right ? 0 : 1;
      }
    }
  }
  EXPECT_LE(noted, 12);
}

}  // namespace
}  // namespace prehend::physics
