// SPDX-License-Identifier: Apache-2.0
// Snapshots -> chunks -> snapshots, bit by bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "harness/episode/frames/chunk.h"

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
  return {.bodies = 3, .grains = {2}, .joints = 1, .hands = {TwoLinks()}, .gazes = 1};
}

/// Body 0 rests, body 1 moves all the time, body 2 now and then; contacts come and go.
std::vector<physics::Snapshot> Frames(std::size_t count) {
  const FrameLayout layout = Layout();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  const physics::LinkPlaces links(layout.hands[0]);
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
    links.Place(hand.palm.X_WB, hand.joints, hand.X_WL);
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
    std::vector<Word> x, y;
    AppendRow(layout, track, a, x);
    AppendRow(layout, track, b, y);
    ASSERT_EQ(x, y) << "track " << track << " at tick " << a.tick;
  }
  std::vector<Word> x, y;
  AppendLinks(a.hands[0].X_WL, x);
  AppendLinks(b.hands[0].X_WL, y);
  ASSERT_EQ(x, y) << a.tick;
  ASSERT_EQ(TableOfPoints({&a.contacts}).words, TableOfPoints({&b.contacts}).words) << a.tick;
  ASSERT_EQ(TableOfPoints({a.resting.get()}).words, TableOfPoints({b.resting.get()}).words);
}

/// Chunks in memory.
struct Chunks {
  std::vector<Chunk> all;
  std::map<std::pair<std::size_t, std::size_t>, std::string> parts;  ///< by part and chunk

  explicit Chunks(const std::vector<physics::Snapshot>& frames) {
    ChunkWriter writer(Layout());
    for (const physics::Snapshot& frame : frames) {
      writer.Add(frame);
      if (writer.IsFull()) Keep(writer.Take());
    }
    if (writer.frames() > 0) Keep(writer.Take());
  }
  void Keep(Chunk chunk) {
    for (const ChunkPart& part : chunk.parts) parts[{part.part, all.size()}] = part.bytes;
    all.push_back(std::move(chunk));
  }
  void Open(FramePlayer& player, std::size_t number, bool follows) const {
    const auto fetch = [&](std::size_t part, bool here) -> std::optional<std::string_view> {
      for (std::size_t chunk = number + 1; chunk-- > (here ? number : 0);) {
        const auto found = parts.find({part, chunk});
        if (found != parts.end()) return found->second;
      }
      return std::nullopt;
    };
    player.Open(fetch, all[number].first_tick, all[number].frames, follows);
  }
};

TEST(Frames, ComeBackOneAfterAnother) {
  const std::vector<physics::Snapshot> frames = Frames(1500);
  const Chunks chunks(frames);
  ASSERT_GT(chunks.all.size(), 2u);
  FramePlayer player(Layout());
  std::size_t next = 0;
  for (std::size_t i = 0; i < chunks.all.size(); ++i) {
    chunks.Open(player, i, i > 0);
    for (std::size_t frame = 0; frame < chunks.all[i].frames; ++frame)
      ExpectSame(player.Show(frame), frames[next++]);
  }
  EXPECT_EQ(next, frames.size());
}

TEST(Frames, SomeOfThemComeBackToo) {
  const std::vector<physics::Snapshot> frames = Frames(1500);
  const Chunks chunks(frames);
  FramePlayer player(Layout());
  for (std::size_t i = 0; i < chunks.all.size(); ++i) {
    chunks.Open(player, i, i > 0);
    for (std::size_t frame = 100; frame < chunks.all[i].frames; frame += 101) {
      const auto first = static_cast<std::size_t>(chunks.all[i].first_tick);
      ExpectSame(player.Show(frame), frames[first - 1 + frame]);
    }
  }
}

TEST(Frames, AnyChunkIsReadAlone) {
  const std::vector<physics::Snapshot> frames = Frames(1500);
  const Chunks chunks(frames);
  for (std::size_t i = chunks.all.size(); i-- > 0;) {
    FramePlayer player(Layout());
    chunks.Open(player, i, false);
    for (const std::size_t frame : {std::size_t{0}, chunks.all[i].frames - 1}) {
      const auto first = static_cast<std::size_t>(chunks.all[i].first_tick);
      ExpectSame(player.Show(frame), frames[first - 1 + frame]);
    }
  }
}

TEST(Frames, WhatRestsHasNoPart) {
  const Chunks chunks(Frames(1500));
  EXPECT_TRUE(chunks.parts.contains({0, 0}));
  EXPECT_FALSE(chunks.parts.contains({0, 1}));
  EXPECT_TRUE(chunks.parts.contains({1, 1}));
  const std::size_t links = Layout().LinksOf(0);
  EXPECT_FALSE(chunks.parts.contains({links, 0})) << "links that follow from the joints";
  EXPECT_TRUE(chunks.parts.contains({links, 2}));
}

TEST(Frames, DamageIsReported) {
  const Chunks chunks(Frames(600));
  const auto opens = [](const Chunks& some) {
    FramePlayer player(Layout());
    for (std::size_t i = 0; i < some.all.size(); ++i) some.Open(player, i, i > 0);
  };
  opens(chunks);
  for (const auto& [place, bytes] : chunks.parts) {
    Chunks bad = chunks;
    for (const std::size_t at : {std::size_t{3}, bytes.size() / 2, bytes.size() - 1}) {
      bad.parts[place] = bytes;
      bad.parts[place][at] ^= 4;
      EXPECT_THROW(opens(bad), Damage) << place.first << " at " << at;
    }
    if (place != std::pair<std::size_t, std::size_t>(1, 0)) continue;
    bad.parts.erase(place);
    EXPECT_THROW(opens(bad), Damage);
  }
}

TEST(Frames, TablesThatNameWhatIsNotThereAreRefused) {
  const FrameLayout layout = Layout();
  const physics::Snapshot blank = BlankSnapshot(layout);
  const ContactPoints points = {
      {.a = {.body = physics::BodyIndex(3)}, .b = {.body = physics::BodyIndex(0)}}};
  EXPECT_THROW((void)PointsOfTable(layout, TableOfPoints({&points}), 1), Damage);
  for (const std::size_t track : {layout.FirstHand(), layout.Gazes()}) {
    std::vector<Word> row;
    AppendRow(layout, track, blank, row);
    for (Word& word : row) word = 7;  // style, body, hand
    physics::Snapshot read = blank;
    EXPECT_THROW(ReadRow(layout, track, Transposed(row, row.size()), 0, read), Damage);
  }
}

}  // namespace
}  // namespace prehend::episode
