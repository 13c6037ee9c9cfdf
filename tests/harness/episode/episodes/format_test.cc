// SPDX-License-Identifier: Apache-2.0
// A file of the format's version is read as it was written, value by value, for ever. The one of
// version 1 has frames of two episodes: one in space (Bullet), and one in the plane (Box2D), where
// links do not follow from joints. A change that fails here needs a new version, and a reader of
// this one.
#include <gtest/gtest.h>

#include <bit>

#include "harness/episode/episodes/load_episode.h"
#include "harness/episode/run/run_text.h"
#include "physics/scene/snapshot.h"

namespace prehend::episode {
namespace {

struct Read {
  std::uint64_t bodies = 0, links = 0, contacts = 0, resting = 0;
  std::size_t frames = 0, points = 0;
};

/// Hashes of all values of all frames.
Read ReadAll(const EpisodeFile& file, const EpisodeRow& row) {
  Read read;
  EpisodeLoader loader(PREHEND_SOURCE_DIR);
  const auto loaded = loader.Load(file, row);
  if (!loaded) ADD_FAILURE() << grammar::Format(loaded.error());
  if (!loaded) return read;
  const FrameLayout layout = LayoutOf(loaded->scenario.scene);
  physics::StateHash bodies, links, contacts, resting;
  const auto add = [](const std::vector<Word>& words, physics::StateHash& hash) {
    for (const Word word : words) hash.Add(word);
  };
  EpisodeFrames frames(file, row, layout);
  const Result<void> played = frames.Play([&](const physics::Snapshot& now) {
    ++read.frames;
    read.points += now.contacts.size();
    std::vector<Word> tracks{static_cast<Word>(now.tick)}, poses;
    for (std::size_t i = 0; i < layout.tracks(); ++i) AppendRow(layout, i, now, tracks);
    for (const physics::HandState& hand : now.hands) AppendLinks(hand.X_WL, poses);
    add(tracks, bodies);
    add(poses, links);
    add(TableOfPoints({&now.contacts}).words, contacts);
    add(TableOfPoints({now.resting.get()}).words, resting);
  });
  EXPECT_TRUE(played) << grammar::Format(ErrorsOf(played));
  read.bodies = bodies.value();
  read.links = links.value();
  read.contacts = contacts.value();
  read.resting = resting.value();
  return read;
}

TEST(Format, Version1IsDecodedBitByBit) {
  const auto file =
      EpisodeFile::Open(PREHEND_SOURCE_DIR "/tests/harness/episode/episodes/version_1.episodes");
  ASSERT_TRUE(file) << grammar::Format(file.error());
  ASSERT_EQ(file->episodes().size(), 2u);
  const Read bullet = ReadAll(*file, file->episodes()[0]);
  EXPECT_EQ(bullet.frames, 80u);
  EXPECT_EQ(bullet.points, 320u);
  EXPECT_EQ(HashText(bullet.bodies), "0x46294eeb10616a0e");
  EXPECT_EQ(HashText(bullet.links), "0x214c008b8d5f2929");
  EXPECT_EQ(HashText(bullet.contacts), "0xb1f559b8c2b644d7");
  EXPECT_EQ(HashText(bullet.resting), "0x7a8c92ea612476c5");
  const Read box2d = ReadAll(*file, file->episodes()[1]);
  EXPECT_EQ(box2d.frames, 60u);
  EXPECT_EQ(box2d.points, 300u);
  EXPECT_EQ(HashText(box2d.bodies), "0xff5384d7b10e92ee");
  EXPECT_EQ(HashText(box2d.links), "0xc6818ccf0d9771e0");
  EXPECT_EQ(HashText(box2d.contacts), "0xf5bdc97d156f0d4c");
}

}  // namespace
}  // namespace prehend::episode
