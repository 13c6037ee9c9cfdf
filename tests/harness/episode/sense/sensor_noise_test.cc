// SPDX-License-Identifier: Apache-2.0
// Sensors with errors: what they change, how much, and that it follows from seed and tick alone.
#include <gtest/gtest.h>

#include <cmath>

#include "harness/episode/sense/sensing.h"

namespace prehend::episode {
namespace {

/// A table and a box that touch, and a hand that touches nothing.
struct Still {
  physics::Scene scene;
  physics::Snapshot snapshot;

  Still() {
    scene.bodies.push_back(
        {.name = "table", .shapes = {{physics::Box{{1, 1, 0.1}}, {}}}, .fixed = true});
    scene.bodies.push_back(
        {.name = "box", .shapes = {{physics::Box{{0.1, 0.1, 0.1}}, {}}}, .mass_kg = 1});
    physics::HandModel model;
    model.sensor_sets = {"fingers", "palm"};
    model.palm_sensor_set = 1;
    model.links.resize(1);
    scene.hands.push_back({.name = "hand", .model = model, .X_WH = {}});
    snapshot.bodies.resize(2);
    snapshot.bodies[1].X_WB.p_m = {0, 0, 0.1};
    snapshot.hands.resize(1);
    snapshot.hands[0].palm.X_WB.p_m = {0, 0, 0.4};
    snapshot.hands[0].X_WL = {{{0.1, 0, 0.4}}};
    snapshot.contacts = {{.a = {.body = physics::BodyIndex(0)},
                          .b = {.body = physics::BodyIndex(1)},
                          .nhat_BA_W = {0, 0, -1},
                          .normal_impulse_n_s = 0.02}};
  }

  physics::Snapshot At(std::int64_t tick) const {
    physics::Snapshot now = snapshot;
    now.tick = tick;
    return now;
  }
};

Sensing With(const Still& still, const scenario::SensorSettings& sensors) {
  return {still.scene, {.sensing_hz = 480, .sensors = sensors}};
}

TEST(SensorNoise, PositionsAreOffByTheStandardDeviation) {
  const Still still;
  Sensing sensing = With(still, {.position_noise_m = 0.003});
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), squares = Eigen::Vector3d::Zero();
  constexpr int kFrames = 4000;
  for (int tick = 1; tick <= kFrames; ++tick) {
    const grammar::Frame frame = sensing.Sense(still.At(tick));
    const Eigen::Vector3d off = frame.entities[1].p_WB_m - Eigen::Vector3d(0, 0, 0.1);
    sum += off;
    squares += off.cwiseAbs2();
    EXPECT_EQ(frame.entities[0].p_WB_m, Eigen::Vector3d::Zero()) << "where the table is, is known";
    EXPECT_EQ(frame.entities[1].v_WB_m_per_s, Eigen::Vector3d::Zero());
  }
  EXPECT_LT((sum / kFrames).norm(), 0.0003);
  for (const double square : squares) EXPECT_NEAR(std::sqrt(square / kFrames), 0.003, 0.0002);
}

TEST(SensorNoise, AHandIsMeasuredAsAWhole) {
  const Still still;
  Sensing perfect = With(still, {}),
          noisy = With(still, {.position_noise_m = 0.003, .rotation_noise_deg = 2});
  const grammar::Frame truth = perfect.Sense(still.At(1)), seen = noisy.Sense(still.At(1));
  const grammar::EntitySample &is = truth.entities[2], &seems = seen.entities[2];
  EXPECT_NE(seems.p_WB_m, is.p_WB_m);
  EXPECT_GT(seems.q_WB.angularDistance(is.q_WB), 0);
  const auto& spheres = truth.hands[0].collision_spheres;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Eigen::Vector3d p_H = is.q_WB.conjugate() * (spheres[i].p_W_m - is.p_WB_m);
    const Eigen::Vector3d p_W = seems.p_WB_m + seems.q_WB * p_H;
    EXPECT_LT((seen.hands[0].collision_spheres[i].p_W_m - p_W).norm(), 1e-12);
  }
}

TEST(SensorNoise, TouchesAndFramesAreMissedInTheirShares) {
  const Still still;
  Sensing sensing = With(still, {.contact_dropout_share = 0.2, .lost_frames_share = 0.1});
  int due = 0, touching = 0;
  bool touched = false;
  for (int tick = 1; tick <= 5000; ++tick) {
    if (!sensing.Due(tick)) continue;
    ++due;
    const grammar::FrameChanges changes = sensing.SenseChanges(still.At(tick));
    EXPECT_EQ(changes.contact_ends.size(), touched && changes.touches.empty() ? 1u : 0u);
    touched = !changes.touches.empty();
    touching += touched;
  }
  EXPECT_NEAR(due, 4500, 75);
  EXPECT_NEAR(touching, 0.8 * due, 100);
}

TEST(SensorNoise, WhatIsSensedDoesNotDependOnWhatWasLookedAtBefore) {
  const Still still;
  const scenario::SensorSettings settings{.position_noise_m = 0.01, .contact_dropout_share = 0.5};
  Sensing one = With(still, settings), other = With(still, settings);
  for (int tick = 1; tick < 50; ++tick) one.Sense(still.At(tick));
  const grammar::Frame after_many = one.Sense(still.At(50)), at_once = other.Sense(still.At(50));
  EXPECT_EQ(after_many.entities[1].p_WB_m, at_once.entities[1].p_WB_m);
  EXPECT_EQ(after_many.touches.size(), at_once.touches.size());

  scenario::SensorSettings reseeded = settings;
  reseeded.seed = 2;
  Sensing third = With(still, reseeded);
  EXPECT_NE(third.Sense(still.At(50)).entities[1].p_WB_m, at_once.entities[1].p_WB_m);
}

}  // namespace
}  // namespace prehend::episode
