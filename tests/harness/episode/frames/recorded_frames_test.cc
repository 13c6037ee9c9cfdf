// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "harness/episode/frames/columns.h"
#include "harness/episode/frames/frame_layout.h"

namespace prehend::episode {
namespace {

/// A table, a hand and a person who looks around; touches and collision spheres come and go.
struct SomeRecording {
  grammar::EntityTable table;
  std::vector<EpisodeFrame> frames;
  std::vector<bool> placed = {true, true, false};

  explicit SomeRecording(std::size_t count) {
    table.ticks_per_second = 1000;
    table.styles = {"wrap", "pinch"};
    table.entities = {{.name = "hand", .classes = {"Hand", "Entity"}, .sensor_sets = {"palm"}},
                      {.name = "table", .classes = {"Table", "Fixed", "Thing", "Entity"}},
                      {.name = "anna", .classes = {"Person", "Entity"}}};
    std::mt19937 random(7);
    std::normal_distribution<double> any;
    const auto point = [&] { return Eigen::Vector3d(any(random), any(random), any(random)); };
    for (std::size_t i = 0; i < count; ++i) {
      EpisodeFrame& frame = frames.emplace_back();
      frame.tick = static_cast<grammar::Tick>(16 * i + i % 3);
      frame.entities.resize(3);
      frame.entities[0].p_WB_m = point();
      frame.entities[0].q_WB =
          Eigen::Quaterniond(any(random), any(random), any(random), any(random)).normalized();
      frame.entities[0].v_WB_m_per_s = point();
      frame.entities[1].asleep = i % 2 == 0;
      frame.entities[1].bridged = i % 3 == 0;
      frame.entities[1].joint_fraction = 0.25;
      frame.entities[2].gazes_at = static_cast<int>(i % 3) - 1;
      frame.hands = {{.entity = 0,
                      .trigger = any(random),
                      .style = static_cast<int>(i % 2),
                      .ahead_W = point().normalized(),
                      .collision_spheres = {}}};
      frame.collision_spheres.resize(1);
      for (std::size_t k = 0; k <= i % 4; ++k) frame.collision_spheres[0].push_back({point(), 0.1});
      if (i % 5 != 0)
        frame.touches.push_back(
            {.a = 0, .b = 1, .normal_force_n = any(random), .p_W_m = point(), .sensor_sets = 1});
      if (i % 2 == 0) frame.touches.push_back({.a = 0, .b = 2, .up_on_a = 0.5});
    }
  }
  std::vector<Columns> Tables() const { return TablesOfFrames(frames, placed); }
};

void ExpectSame(const EpisodeFrame& a, const EpisodeFrame& b) {
  EXPECT_EQ(a.tick, b.tick);
  ASSERT_EQ(a.entities.size(), b.entities.size());
  for (std::size_t i = 0; i < a.entities.size(); ++i) {
    EXPECT_EQ(a.entities[i].p_WB_m, b.entities[i].p_WB_m);
    EXPECT_EQ(a.entities[i].q_WB.coeffs(), b.entities[i].q_WB.coeffs());
    EXPECT_EQ(a.entities[i].v_WB_m_per_s, b.entities[i].v_WB_m_per_s);
    EXPECT_EQ(a.entities[i].asleep, b.entities[i].asleep);
    EXPECT_EQ(a.entities[i].bridged, b.entities[i].bridged);
    EXPECT_EQ(a.entities[i].joint_fraction, b.entities[i].joint_fraction);
    EXPECT_EQ(a.entities[i].gazes_at, b.entities[i].gazes_at);
  }
  ASSERT_EQ(a.hands.size(), b.hands.size());
  EXPECT_EQ(a.hands[0].entity, b.hands[0].entity);
  EXPECT_EQ(a.hands[0].trigger, b.hands[0].trigger);
  EXPECT_EQ(a.hands[0].style, b.hands[0].style);
  EXPECT_EQ(a.hands[0].ahead_W, b.hands[0].ahead_W);
  ASSERT_EQ(a.collision_spheres[0].size(), b.collision_spheres[0].size());
  for (std::size_t i = 0; i < a.collision_spheres[0].size(); ++i)
    EXPECT_EQ(a.collision_spheres[0][i].p_W_m, b.collision_spheres[0][i].p_W_m);
  ASSERT_EQ(a.touches.size(), b.touches.size());
  for (std::size_t i = 0; i < a.touches.size(); ++i) {
    EXPECT_EQ(a.touches[i].b, b.touches[i].b);
    EXPECT_EQ(a.touches[i].up_on_a, b.touches[i].up_on_a);
    EXPECT_EQ(a.touches[i].normal_force_n, b.touches[i].normal_force_n);
    EXPECT_EQ(a.touches[i].p_W_m, b.touches[i].p_W_m);
    EXPECT_EQ(a.touches[i].sensor_sets, b.touches[i].sensor_sets);
  }
}

TEST(RecordedFrames, ComeBackBitByBit) {
  for (const std::size_t count : {1, 2, 57}) {
    const SomeRecording recording(count);
    const RecordedFrames read = FramesOfTables(recording.Tables(), recording.table);
    EXPECT_EQ(read.placed, recording.placed);
    ASSERT_EQ(read.frames.size(), count);
    for (std::size_t i = 0; i < count; ++i) ExpectSame(read.frames[i], recording.frames[i]);
  }
}

TEST(RecordedFrames, ChunksAreFilledButNotOverfilled) {
  const SomeRecording recording(1000);
  const std::size_t first = FramesOfChunk(recording.frames);
  EXPECT_EQ(first, 480);
  EXPECT_EQ(FramesOfChunk(std::span(recording.frames).last(3)), 3);
}

TEST(RecordedFrames, OtherTablesAreRefusedOrHarmless) {
  const SomeRecording recording(20);
  const std::vector<Columns> good = recording.Tables();
  const auto read = [&](const std::vector<Columns>& tables) {
    return FramesOfTables(tables, recording.table);
  };
  EXPECT_THROW((void)read({}), Damage);
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::vector<Columns> bad = good;
    bad[i] = Columns(bad[i].rows, bad[i].width + 1);
    EXPECT_THROW((void)read(bad), Damage) << i;
  }
  std::mt19937 random(3);
  for (int i = 0; i < 3000; ++i) {
    std::vector<Columns> bad = good;
    std::vector<Word>& words = bad[random() % bad.size()].words;
    words[random() % words.size()] = random() % 6 - 2;
    try {
      for (const EpisodeFrame& frame : read(bad).frames) {
        for (const grammar::Touch& touch : frame.touches) EXPECT_LT(touch.b, 3);
        for (const grammar::EntitySample& look : frame.entities) EXPECT_LT(look.gazes_at, 3);
      }
    } catch (const Damage&) {
    }
  }
}

}  // namespace
}  // namespace prehend::episode
