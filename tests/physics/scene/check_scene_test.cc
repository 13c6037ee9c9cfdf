// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "physics/simulation.h"

namespace prehend::physics {
namespace {

Scene TwoCartonsAndAHand() {
  Scene scene;
  scene.bodies = {{.name = "milk", .shapes = {{Box{}}}, .mass_kg = 1},
                  {.name = "table", .shapes = {{Box{}}}, .fixed = true}};
  scene.joints = {{.kind = JointKind::kSlider, .body = BodyIndex(0), .base = BodyIndex(1)}};
  scene.hands.resize(1);
  scene.hands[0].model.links.resize(2);
  scene.hands[0].model.links[1].parent = LinkIndex(0);
  scene.hands[0].model.styles = {{.name = "wrap", .frames = {{0, 0}, {1, 1}}, .effort = {1, 1}}};
  scene.persons = {{.name = "anna", .head = BodyIndex(1), .right_hand = HandIndex(0)}};
  return scene;
}

Snapshot Of(const Scene& scene) {
  Snapshot now;
  now.bodies.resize(scene.bodies.size());
  now.joints.resize(scene.joints.size());
  now.gazes.resize(scene.persons.size());
  now.hands.resize(1);
  now.hands[0].joints.resize(2);
  now.hands[0].X_WL.resize(2);
  now.contacts = {{.a = {.body = BodyIndex(0)}, .b = {.hand = HandIndex(0), .link = LinkIndex(1)}}};
  return now;
}

TEST(CheckScene, RefusesWhatNoSceneIs) {
  EXPECT_NO_THROW(CheckScene(TwoCartonsAndAHand()));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::function<void(Scene&)> mistakes[] = {
      [](Scene& s) { s.joints[0].base = BodyIndex(2); },
      [](Scene& s) { s.joints[0].base = kNone; },
      [](Scene& s) { s.joints[0].base = s.joints[0].body; },
      [](Scene& s) { s.joints[0].axis_W *= 2; },
      [](Scene& s) { s.bodies[0].X_WB.q.coeffs() *= 1.01; },
      [&](Scene& s) { s.bodies[0].X_WB.p_m.x() = nan; },
      [&](Scene& s) { s.bodies[0].X_WB.q.w() = nan; },
      [&](Scene& s) { s.bodies[0].mass_kg = nan; },
      [](Scene& s) { s.hands[0].model.links[0].parent = LinkIndex(1); },
      [](Scene& s) { s.hands[0].model.styles[0].effort.pop_back(); },
      [](Scene& s) { s.hands[0].model.styles[0].frames[1].pop_back(); },
      [](Scene& s) { s.persons[0].head = BodyIndex(7); },
      [](Scene& s) { s.persons[0].left_hand = HandIndex(1); },
      [](Scene& s) { s.world.rate_hz = 0; }};
  for (const auto& mistake : mistakes) {
    Scene scene = TwoCartonsAndAHand();
    mistake(scene);
    EXPECT_THROW(CheckScene(scene), std::logic_error) << &mistake - mistakes;
  }
}

TEST(IsOf, SaysWhetherASnapshotFitsItsScene) {
  const Scene scene = TwoCartonsAndAHand();
  EXPECT_TRUE(IsOf(scene, Of(scene)));
  const std::function<void(Snapshot&)> mistakes[] = {
      [](Snapshot& now) { now.bodies.pop_back(); },
      [](Snapshot& now) { now.gazes.clear(); },
      [](Snapshot& now) { now.hands[0].joints.pop_back(); },
      [](Snapshot& now) { now.gazes[0].body = BodyIndex(2); },
      [](Snapshot& now) { now.contacts[0].a.body = BodyIndex(2); },
      [](Snapshot& now) { now.contacts[0].a = {}; },
      [](Snapshot& now) { now.contacts[0].b.link = LinkIndex(2); }};
  for (const auto& mistake : mistakes) {
    Snapshot now = Of(scene);
    mistake(now);
    EXPECT_FALSE(IsOf(scene, now)) << &mistake - mistakes;
  }
}

}  // namespace
}  // namespace prehend::physics
