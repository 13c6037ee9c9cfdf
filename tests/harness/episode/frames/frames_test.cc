// SPDX-License-Identifier: Apache-2.0
// Snapshots -> chunks -> snapshots, bit by bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "harness/episode/frames/chunk.h"
#include "harness/episode/frames/contact_coding.h"
#include "harness/episode/frames/frame_player.h"

namespace prehend::episode {
namespace {

physics::HandModel TwoLinks() {
  physics::HandModel model;
  model.links.resize(2);
  model.links[1].parent = physics::LinkIndex(0);
  model.links[1].slides = true;
  model.links[1].pivot_m = {0.03, 0, 0};
  model.styles.resize(2);
  return model;
}

FrameLayout Layout() {
  return {
      .rate_hz = 480, .bodies = 3, .grains = {2}, .joints = 1, .hands = {TwoLinks()}, .gazes = 1};
}

/// Body 0 rests, body 1 moves all the time, body 2 now and then; contacts come and go.
std::vector<physics::Snapshot> Frames(std::size_t count) {
  const FrameLayout layout = Layout();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  LinkGuess links(layout.hands[0]);
  physics::Snapshot now = BlankSnapshot(layout);
  now.bodies[0].X_WB.p_m = {1, 2, 3};
  std::shared_ptr<const ContactPoints> resting;
  std::vector<physics::Snapshot> frames;
  for (std::size_t i = 0; i < count; ++i) {
    now.tick = 1 + static_cast<std::int64_t>(i);
    const double t = static_cast<double>(i) / 480;
    now.bodies[1].X_WB.p_m = {t, t * t, any(random)};
    now.bodies[1].v_WB_m_per_s = {1, 2 * t, any(random)};
    now.moved_tick[1] = now.tick;
    if (i % 700 < 20) {
      now.bodies[2].X_WB.p_m.x() += 0.01;
      now.bodies[2].asleep = i % 700 == 19;
      now.moved_tick[2] = now.tick;
    }
    if (i % 300 == 50) {
      resting = std::make_shared<const ContactPoints>(ContactPoints(
          1 + i % 3, {.a = {.body = physics::BodyIndex(0)}, .b = {.body = physics::BodyIndex(2)}}));
    }
    if (i == 900) resting.reset();
    now.resting = resting;
    now.grains[1] = {any(random), 0, t};
    now.joints[0] = {t, t / 2};
    physics::HandState& hand = now.hands[0];
    hand.palm.X_WB.p_m = {0, t, 0};
    hand.joints = {std::sin(t), 0.001 * t};
    hand.style = i % 100 == 0 ? 1 : 0;
    std::vector<PlacedLinks> placed(1 + links.size());
    placed[0].PutPalm(0, hand.palm.X_WB);
    for (std::size_t link = 0; link < links.size(); ++link) {
      const auto parent = static_cast<std::size_t>(links.ParentOf(link) + 1);
      links.Guess(link, placed[parent], {hand.joints[link]}, placed[link + 1]);
      hand.X_WL[link] = placed[link + 1].X_WL[0];
    }
    if (i >= 480) hand.X_WL[1].p_m.x() += 1e-15 * any(random);
    now.gazes[0].body = physics::BodyIndex(static_cast<int>(i % 4) - 1);
    now.contacts.clear();
    for (std::size_t k = 0; k < i / 10 % 4; ++k)
      now.contacts.push_back(
          {.a = {.body = physics::BodyIndex(1)},
           .b = {.hand = physics::HandIndex(0),
                 .link = physics::LinkIndex(std::min(static_cast<int>(k) - 1, 1))},
           .p_W_m = {any(random), t, 0},
           .normal_impulse_n_s = any(random)});
    frames.push_back(now);
  }
  return frames;
}

void ExpectSame(const physics::Snapshot& a, const physics::Snapshot& b) {
  const FrameLayout layout = Layout();
  ASSERT_EQ(a.tick, b.tick);
  for (std::size_t track = 0; track < layout.tracks(); ++track) {
    std::vector<Word> x(layout.Width(track)), y(layout.Width(track));
    ReadRow(layout, track, a, x);
    ReadRow(layout, track, b, y);
    ASSERT_EQ(x, y) << "track " << track << " at tick " << a.tick;
  }
  for (std::size_t i = 0; i < a.hands[0].X_WL.size(); ++i) {
    ASSERT_EQ(a.hands[0].X_WL[i].p_m, b.hands[0].X_WL[i].p_m) << a.tick;
    ASSERT_EQ(a.hands[0].X_WL[i].q.coeffs(), b.hands[0].X_WL[i].q.coeffs()) << a.tick;
  }
  for (const int part : {0, 1}) {
    const auto x = a.AllContacts()[static_cast<std::size_t>(part)],
               y = b.AllContacts()[static_cast<std::size_t>(part)];
    ASSERT_EQ(x.size(), y.size()) << a.tick;
    for (std::size_t i = 0; i < x.size(); ++i) ASSERT_TRUE(SamePoint(x[i], y[i])) << a.tick;
  }
}

/// Chunks in memory.
struct Chunks {
  std::vector<Chunk> all;
  std::map<std::pair<std::size_t, std::size_t>, std::string> parts;

  explicit Chunks(const std::vector<physics::Snapshot>& frames) {
    ChunkWriter writer(Layout());
    for (const physics::Snapshot& frame : frames) {
      writer.Add(frame);
      if (writer.IsFull()) Keep(writer.Take());
    }
    if (writer.frames() > 0) Keep(writer.Take());
  }
  void Keep(Chunk chunk) {
    for (const ChunkPart& part : chunk.parts) parts[{all.size(), part.part}] = part.bytes;
    all.push_back(std::move(chunk));
  }
  FetchPart At(std::size_t number) {
    return [this, number](Word back, std::size_t part) -> std::optional<std::string_view> {
      if (back > number) return std::nullopt;
      const auto found = parts.find({number - static_cast<std::size_t>(back), part});
      if (found == parts.end()) return std::nullopt;
      return found->second;
    };
  }
};

TEST(Frames, ComeBackOneAfterAnother) {
  const std::vector<physics::Snapshot> frames = Frames(1500);
  Chunks chunks(frames);
  ASSERT_GT(chunks.all.size(), 2u);
  FramePlayer player(Layout());
  std::size_t next = 0;
  for (std::size_t i = 0; i < chunks.all.size(); ++i) {
    ASSERT_TRUE(player.Open(chunks.At(i), i > 0));
    for (std::size_t frame = 0; frame < player.ticks().size(); ++frame) {
      const physics::Snapshot* shown = player.Show(frame);
      ASSERT_TRUE(shown);
      ExpectSame(*shown, frames[next++]);
    }
  }
  EXPECT_EQ(next, frames.size());
}

TEST(Frames, SomeOfThemComeBackToo) {
  const std::vector<physics::Snapshot> frames = Frames(1500);
  Chunks chunks(frames);
  FramePlayer player(Layout());
  for (std::size_t i = 0; i < chunks.all.size(); ++i) {
    ASSERT_TRUE(player.Open(chunks.At(i), i > 0));
    for (std::size_t frame = 100; frame < player.ticks().size(); frame += 101) {
      const auto tick = player.ticks()[frame];
      ExpectSame(*player.Show(frame), frames[static_cast<std::size_t>(tick) - 1]);
    }
  }
}

TEST(Frames, AnyChunkIsReadAlone) {
  const std::vector<physics::Snapshot> frames = Frames(1500);
  Chunks chunks(frames);
  for (std::size_t i = chunks.all.size(); i-- > 0;) {
    FramePlayer player(Layout());
    ASSERT_TRUE(player.Open(chunks.At(i), false));
    for (const std::size_t frame : {std::size_t{0}, player.ticks().size() - 1}) {
      const auto tick = player.ticks()[frame];
      ExpectSame(*player.Show(frame), frames[static_cast<std::size_t>(tick) - 1]);
    }
  }
}

TEST(Frames, WhatRestsHasNoPart) {
  Chunks chunks(Frames(1500));
  const std::size_t resting = FrameLayout::PartOfTrack(0), moving = FrameLayout::PartOfTrack(1);
  EXPECT_TRUE(chunks.parts.contains({0, resting}));
  EXPECT_FALSE(chunks.parts.contains({1, resting}));
  EXPECT_TRUE(chunks.parts.contains({1, moving}));
  const std::size_t links = Layout().PartOfLinks(0);
  EXPECT_FALSE(chunks.parts.contains({0, links})) << "links that follow from the joints";
  EXPECT_TRUE(chunks.parts.contains({2, links}));
}

TEST(Frames, DamageIsReportedOrReadAsSomething) {
  std::mt19937 random(5);
  Chunks chunks(Frames(600));
  for (int trial = 0; trial < 300; ++trial) {
    Chunks bad = chunks;
    for (auto& [key, bytes] : bad.parts) {
      if (random() % 2 == 0) bytes[random() % bytes.size()] = static_cast<char>(random());
    }
    FramePlayer player(Layout());
    for (std::size_t i = 0; i < bad.all.size(); ++i) {
      if (!player.Open(bad.At(i), i > 0)) break;
      for (std::size_t frame = 0; frame < player.ticks().size(); ++frame) (void)player.Show(frame);
    }
  }
  chunks.parts.erase({1, FrameLayout::kHead});
  FramePlayer player(Layout());
  EXPECT_TRUE(player.Open(chunks.At(0), false));
  EXPECT_FALSE(player.Open(chunks.At(1), true));
}

}  // namespace
}  // namespace prehend::episode
