// SPDX-License-Identifier: Apache-2.0
// Snapshots made by hand -> frames.
#include "harness/episode/sense/sensing.h"

#include <gtest/gtest.h>

#include <utility>

#include "harness/episode/sense/episode_format.h"

namespace prehend::episode {
namespace {

/// A table, a box on it, a hand with a palm and two one-link digits in different sensor sets.
physics::Scene TwoBodiesAndAHand() {
  physics::Scene scene;
  scene.bodies.push_back(
      {.name = "table", .shapes = {{physics::Box{{1, 1, 0.1}}, {}}}, .fixed = true});
  scene.bodies.push_back(
      {.name = "box", .shapes = {{physics::Box{{0.1, 0.1, 0.1}}, {}}}, .mass_kg = 1});
  physics::HandModel model;
  model.sensor_sets = {"fingers", "thumb", "palm"};
  model.palm_sensor_set = 2;
  model.links.resize(2);
  model.links[1].sensor_set = 1;
  scene.hands.push_back({.name = "hand", .model = model, .X_WH = {}});
  return scene;
}

physics::Snapshot StillSnapshot(std::int64_t tick) {
  physics::Snapshot snapshot;
  snapshot.tick = tick;
  snapshot.bodies.resize(2);
  snapshot.hands.resize(1);
  snapshot.hands[0].X_WL.resize(2);
  return snapshot;
}

constexpr physics::ContactSide kTable{.body = physics::BodyIndex(0)},
    kBox{.body = physics::BodyIndex(1)},
    kPalm{.hand = physics::HandIndex(0), .link = physics::kNone};
constexpr physics::ContactSide kFinger{.hand = physics::HandIndex(0),
                                       .link = physics::LinkIndex(0)},
    kThumb{.hand = physics::HandIndex(0), .link = physics::LinkIndex(1)};

physics::ContactPoint Point(physics::ContactSide a, physics::ContactSide b, double up,
                            double impulse) {
  return {
      .a = a, .b = b, .nhat_BA_W = {std::sqrt(1 - up * up), 0, up}, .normal_impulse_n_s = impulse};
}

TEST(Sensing, TellsWhereAJointStands) {
  physics::Scene scene = TwoBodiesAndAHand();
  scene.joints.push_back(
      {.kind = physics::JointKind::kSlider, .body = physics::BodyIndex(1), .upper = 0.4});
  physics::Snapshot snapshot = StillSnapshot(1);
  snapshot.joints = {{.position = 0.1, .fraction = 0.25}};
  Sensing sensing(scene, {.sensing_hz = 480});
  const grammar::Frame frame = sensing.Sense(snapshot);
  EXPECT_EQ(frame.entities[1].joint_fraction, 0.25);
  EXPECT_EQ(frame.entities[0].joint_fraction, 0);
}

TEST(Sensing, HandsWithDifferentStylesShareOneListOfNames) {
  physics::Scene scene = TwoBodiesAndAHand();
  scene.hands.push_back(scene.hands[0]);
  scene.hands[0].model.styles = {{.name = "wrap"}, {.name = "pinch"}};
  scene.hands[1].model.styles = {{.name = "jaws"}, {.name = "wrap"}};
  EXPECT_EQ(StyleNames(scene), (std::vector<std::string>{"wrap", "pinch", "jaws"}));

  physics::Snapshot snapshot = StillSnapshot(1);
  snapshot.hands.push_back(snapshot.hands[0]);
  snapshot.hands[0].style = 1;
  Sensing sensing(scene, {.sensing_hz = 480});
  const grammar::Frame frame = sensing.Sense(snapshot);
  EXPECT_EQ(frame.hands[0].style, 1);  // pinch
  EXPECT_EQ(frame.hands[1].style, 2);  // jaws
}

TEST(Sensing, LooksAtEveryRateWithoutDrift) {
  const physics::Scene scene = TwoBodiesAndAHand();
  for (const int hz : {30, 60, 90, 240, 480, 7}) {
    const Sensing sensing(scene, {.sensing_hz = hz});
    int looks = 0;
    for (std::int64_t tick = 1; tick <= 480 * 10; ++tick) looks += sensing.Due(tick);
    EXPECT_EQ(looks, hz * 10);
  }
}

TEST(Sensing, PointsOfAPairBecomeOneTouchWithItsForce) {
  const physics::Scene scene = TwoBodiesAndAHand();
  Sensing sensing(scene, {.sensing_hz = 240});
  physics::Snapshot snapshot = StillSnapshot(2);
  // The normal points from the box into the table: down on the table, up on the box.
  snapshot.contacts = {Point(kTable, kBox, -1, 0.01), Point(kTable, kBox, -0.9, 0.01)};
  const grammar::Frame frame = sensing.Sense(snapshot);
  ASSERT_EQ(frame.touches.size(), 1u);
  EXPECT_EQ(frame.touches[0].a, 0);
  EXPECT_EQ(frame.touches[0].b, 1);
  EXPECT_DOUBLE_EQ(frame.touches[0].up_on_b, 1);
  EXPECT_DOUBLE_EQ(frame.touches[0].up_on_a, -0.9);
  EXPECT_NEAR(frame.touches[0].normal_force_n, 0.02 * 480, 1e-12);
}

TEST(Sensing, AStrayPointWithoutLoadDoesNotHold) {
  const physics::Scene scene = TwoBodiesAndAHand();
  Sensing sensing(scene, {.sensing_hz = 240});
  physics::Snapshot snapshot = StillSnapshot(2);
  snapshot.contacts = {Point(kTable, kBox, 0, 1.0), Point(kTable, kBox, -1, 0.001)};
  EXPECT_NEAR(sensing.Sense(snapshot).touches[0].up_on_b, 0, 1e-12);
  Sensing to_the_last_point(scene, {.sensing_hz = 240, .bearing_share = 0});
  EXPECT_NEAR(to_the_last_point.Sense(snapshot).touches[0].up_on_b, 1, 1e-12);
}

TEST(Sensing, ATouchIsWhereItBearsLoad) {
  const physics::Scene scene = TwoBodiesAndAHand();
  Sensing sensing(scene, {.sensing_hz = 240});
  physics::Snapshot snapshot = StillSnapshot(2);
  snapshot.contacts = {Point(kTable, kBox, -1, 0.03), Point(kTable, kBox, -1, 0.01)};
  snapshot.contacts[0].p_W_m = {0.1, 0, 0};
  snapshot.contacts[1].p_W_m = {0.5, 0, 0};
  const grammar::Touch touch = sensing.Sense(snapshot).touches[0];
  EXPECT_TRUE(touch.p_W_m.isApprox(Eigen::Vector3d(0.2, 0, 0), 1e-9));
  EXPECT_TRUE(touch.nhat_BA_W.isApprox(-Eigen::Vector3d::UnitZ(), 1e-9)) << "on the table";
  snapshot.tick = 4;
  snapshot.contacts = {Point(kTable, kBox, 0, 0.03)};
  EXPECT_TRUE(sensing.Sense(snapshot).touches[0].nhat_BA_W.isZero()) << "side by side";
}

TEST(Sensing, LinksBecomeSensorSetsOfTheHandEntity) {
  const physics::Scene scene = TwoBodiesAndAHand();
  Sensing sensing(scene, {.sensing_hz = 240});
  physics::Snapshot snapshot = StillSnapshot(2);
  snapshot.contacts = {Point(kBox, kFinger, 0, 0.1), Point(kBox, kThumb, 0, 0.1)};
  const grammar::Frame frame = sensing.Sense(snapshot);
  ASSERT_EQ(frame.touches.size(), 1u);
  EXPECT_EQ(frame.touches[0].a, 1);
  EXPECT_EQ(frame.touches[0].b, 2);
  EXPECT_EQ(frame.touches[0].sensor_sets, 0b011u);

  snapshot.contacts = {Point(kBox, kPalm, 0, 0.1)};
  EXPECT_EQ(sensing.Sense(snapshot).touches[0].sensor_sets, 0b100u);
}

TEST(Sensing, CollisionSpheresFollowPalmAndLinks) {
  const physics::Scene scene = TwoBodiesAndAHand();
  Sensing sensing(scene, {.sensing_hz = 240});
  physics::Snapshot snapshot = StillSnapshot(2);
  snapshot.hands[0].palm.X_WB.p_m = {0, 0, 5};
  snapshot.hands[0].X_WL[0].p_m = {1, 0, 5};
  snapshot.hands[0].X_WL[1].p_m = {2, 0, 5};
  const grammar::HandSample hand = sensing.Sense(snapshot).hands[0];
  ASSERT_EQ(hand.entity, 2);
  double low = 1e9, high = -1e9;
  for (const grammar::CollisionSphere& collision_sphere : hand.collision_spheres) {
    EXPECT_NEAR(collision_sphere.p_W_m.z(), 5, 1e-12);
    EXPECT_GT(collision_sphere.radius_m, 0);
    low = std::min(low, collision_sphere.p_W_m.x() - collision_sphere.radius_m);
    high = std::max(high, collision_sphere.p_W_m.x() + collision_sphere.radius_m);
  }
  const physics::HandModel& model = scene.hands[0].model;
  EXPECT_NEAR(low, -model.palm_size_m.x() / 2, 1e-9);
  EXPECT_NEAR(high, 2 + model.links[1].length_m / 2, 1e-9);
}

/// All that a snapshot can say, from what rests and what moves, and back again.
TEST(Sensing, ChangesAddUpToTheWhole) {
  const physics::Scene scene = TwoBodiesAndAHand();
  Sensing by_changes(scene, {.sensing_hz = 480});
  physics::Snapshot first = StillSnapshot(1);
  first.moved_tick = {0, 1};
  first.bodies[1].X_WB.p_m.z() = 0.1;
  first.contacts = {Point(kTable, kBox, -1, 0.01)};
  const grammar::FrameChanges all = by_changes.SenseChanges(first);
  ASSERT_EQ(all.entities.size(), 1u) << "the rest stands at the origin";
  EXPECT_EQ(all.entities[0].entity, 1);
  EXPECT_EQ(all.touches.size(), 1u);

  physics::Snapshot asleep = first;
  asleep.tick = 2;
  asleep.moved_tick = {0, 2};
  asleep.resting = std::make_shared<const std::vector<physics::ContactPoint>>(
      std::exchange(asleep.contacts, {}));
  const grammar::FrameChanges nothing = by_changes.SenseChanges(asleep);
  EXPECT_TRUE(nothing.entities.empty());
  EXPECT_TRUE(nothing.touches.empty() && nothing.contact_ends.empty()) << "only asleep now";
  EXPECT_EQ(by_changes.Whole().touches.size(), 1u);

  physics::Snapshot lifted = asleep;
  lifted.tick = 3;
  lifted.moved_tick = {0, 3};
  lifted.bodies[1].X_WB.p_m.z() = 0.2;
  lifted.resting = nullptr;
  lifted.contacts = {Point(kBox, kFinger, 0, 0.1)};
  const grammar::FrameChanges moved = by_changes.SenseChanges(lifted);
  ASSERT_EQ(moved.entities.size(), 1u);
  EXPECT_EQ(moved.entities[0].look.p_WB_m.z(), 0.2);
  ASSERT_EQ(moved.touches.size(), 1u);
  EXPECT_EQ(moved.touches[0].b, 2);
  ASSERT_EQ(moved.contact_ends.size(), 1u);
  EXPECT_EQ(std::pair(moved.contact_ends[0].a, moved.contact_ends[0].b), std::pair(0, 1));

  EXPECT_EQ(by_changes.Sense(first).entities[1].p_WB_m.z(), 0.1) << "an earlier moment";
}

TEST(Sensing, WhatHasNotMovedIsNotLookedAt) {
  const physics::Scene scene = TwoBodiesAndAHand();
  Sensing sensing(scene, {.sensing_hz = 240});
  physics::Snapshot snapshot = StillSnapshot(2);
  snapshot.moved_tick = {0, 1};
  sensing.SenseChanges(snapshot);
  snapshot.tick = 4;
  snapshot.bodies[1].X_WB.p_m.z() = 1;  // as no world would do it
  EXPECT_TRUE(sensing.SenseChanges(snapshot).entities.empty());
  snapshot.tick = 6;
  snapshot.moved_tick = {0, 5};  // between two looks
  EXPECT_EQ(sensing.SenseChanges(snapshot).entities.size(), 1u);
}

}  // namespace
}  // namespace prehend::episode
