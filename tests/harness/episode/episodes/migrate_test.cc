// SPDX-License-Identifier: Apache-2.0
// The file version_1.episodes was written by a program of version 1 of the format: 0.6 s in which a
// thing lies on a hand; version_2.episodes, the same, by one of version 2.
#include "harness/episode/episodes/migrate.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "harness/episode/episodes/load_episode.h"
#include "harness/episode/frames/contact_coding.h"

namespace prehend::episode {
namespace {

namespace fs = std::filesystem;

const std::string kSource = PREHEND_SOURCE_DIR;
const std::string kOldFile = kSource + "/tests/harness/episode/episodes/version_1.episodes";

std::string NewFile() {
  const fs::path folder =
      fs::temp_directory_path() / ("prehend_migrate_" + std::to_string(getpid()));
  fs::remove_all(folder);
  fs::create_directories(folder);
  return (folder / "new.episodes").string();
}

std::vector<physics::Snapshot> FramesOf(const EpisodeFile& file, int version) {
  EpisodeLoader loader(kSource);
  const EpisodeRow& row = file.episodes().front();
  FrameLayout layout = LayoutOf(loader.Load(file, row)->scenario.scene);
  layout.version = version;
  std::vector<physics::Snapshot> frames;
  EpisodeFrames played(file, row, layout);
  EXPECT_EQ(played.Play([&](const physics::Snapshot& frame) { frames.push_back(frame); }), "");
  return frames;
}

TEST(Migrate, AnOldFileBecomesANewOneWithEveryFrame) {
  const std::string file = NewFile();
  const auto migrated = MigrateFile(kOldFile, file, kSource);
  ASSERT_TRUE(migrated) << grammar::Format(migrated.error());
  EXPECT_EQ(migrated->episodes, 1);

  const auto old = EpisodeFile::OpenOld(kOldFile);
  const auto now = EpisodeFile::Open(file);
  ASSERT_TRUE(old && now);
  const EpisodeRow &before = old->episodes().front(), &after = now->episodes().front();
  EXPECT_EQ(after.uuid, before.uuid);
  EXPECT_EQ(after.state_hash, before.state_hash);
  EXPECT_EQ(now->TimelineOf(after)->events.size(), old->TimelineOf(before)->events.size());
  EXPECT_EQ(now->TaskOf(after)->Identity(), old->TaskOf(before)->Identity());

  const auto x = FramesOf(*old, 1), y = FramesOf(*now, kFrameVersion);
  ASSERT_EQ(x.size(), y.size());
  std::size_t points = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    ASSERT_EQ(x[i].contacts.size(), y[i].contacts.size());
    points += x[i].contacts.size();
    for (std::size_t k = 0; k < x[i].contacts.size(); ++k)
      ASSERT_TRUE(SamePoint(x[i].contacts[k], y[i].contacts[k])) << x[i].tick;
    for (std::size_t link = 0; link < x[i].hands[0].X_WL.size(); ++link) {
      ASSERT_EQ(x[i].hands[0].X_WL[link].p_m, y[i].hands[0].X_WL[link].p_m) << x[i].tick;
      ASSERT_EQ(x[i].hands[0].X_WL[link].q.coeffs(), y[i].hands[0].X_WL[link].q.coeffs());
    }
  }
  EXPECT_GT(points, 100u);
  EpisodeLoader loader(kSource);
  EXPECT_TRUE(Replay(*now, after, *loader.Load(*now, after)));
}

TEST(Migrate, AFileWithoutChecksumsIsReadAndWrittenAndBecomesOneWithThem) {
  const std::string file = NewFile(), old = file + ".old";
  fs::copy_file(kSource + "/tests/harness/episode/episodes/version_2.episodes", old);
  const auto read = [](const std::string& path) {
    const auto opened = EpisodeFile::Open(path);
    EXPECT_TRUE(opened) << grammar::Format(ErrorsOf(opened));
    const EpisodeRow& row = opened->episodes().front();
    EpisodeLoader loader(kSource);
    EXPECT_TRUE(Replay(*opened, row, *loader.Load(*opened, row)));
    return opened->version();
  };
  EXPECT_EQ(read(old), 2);
  (void)OpenToWrite(old);
  EXPECT_EQ(read(old), 2) << "it stays what it is";
  ASSERT_TRUE(MigrateFile(old, file, kSource));
  EXPECT_EQ(read(file), 3);
}

TEST(Migrate, WhatIsOldOrNewIsSaid) {
  const std::string file = NewFile();
  const auto refused = EpisodeFile::Open(kOldFile);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().front().message,
            "has version 1 of the format, this program reads version 3; 'prehend episode migrate " +
                kOldFile + " -o NEW.episodes' writes a file of it that can be read");
  ASSERT_TRUE(MigrateFile(kOldFile, file, kSource));
  EXPECT_EQ(MigrateFile(kOldFile, file, kSource).error().front().message, "is there already");
  EXPECT_EQ(MigrateFile(file, file + "2", kSource).error().front().message,
            "has version 3 of the format already");
  EXPECT_FALSE(fs::exists(file + "2"));
}

TEST(Migrate, OfADamagedFileNothingIsLeft) {
  const std::string file = NewFile();
  std::ifstream in(kOldFile, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  for (std::size_t i = bytes.size() / 2; i < bytes.size() / 2 + 20000; i += 50) bytes[i] ^= 0x55;
  const std::string bad = file + ".bad";
  std::ofstream(bad, std::ios::binary) << bytes;
  EXPECT_FALSE(MigrateFile(bad, file, kSource));
  EXPECT_FALSE(fs::exists(file));
}

}  // namespace
}  // namespace prehend::episode
