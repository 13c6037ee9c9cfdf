// SPDX-License-Identifier: Apache-2.0
// Rows of an episode file that contradict each other, on pages that have the right checksums; and a
// file that another process is writing.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "harness/base/base/atomic_file.h"
#include "harness/episode/episodes/episode_file.h"

namespace prehend::episode {
namespace {

namespace fs = std::filesystem;

class Contradictions : public testing::Test {
 protected:
  /// The file of the format's version 1, whose first episode has ticks up to 2479 and of it the
  /// chunk from 2400 on; after this change to its rows.
  Result<EpisodeFile> After(const std::string& sql) const {
    fs::copy_file(PREHEND_SOURCE_DIR "/tests/harness/episode/episodes/version_1.episodes", file_,
                  fs::copy_options::overwrite_existing);
    Database(file_, Database::Mode::kWrite).Execute(sql);
    return EpisodeFile::Open(file_);
  }

  template <typename T>
  static std::string MessageOf(const Result<T>& read) {
    return read ? "" : read.error().front().message;
  }

  std::string TimelineAfter(const std::string& sql) const {
    const Result<EpisodeFile> opened = After(sql);
    return opened ? MessageOf(opened->TimelineOf(opened->episodes()[0])) : MessageOf(opened);
  }

  std::string FramesAfter(const std::string& sql, int rate_hz = 480) const {
    const Result<EpisodeFile> opened =
        After("INSERT INTO chunk VALUES(1, 1, 480, 480), (1, 481, 2399, 1919); " + sql);
    return MessageOf(opened->CheckFrames(opened->episodes()[0], rate_hz));
  }

  const TemporaryFolder folder_;
  const std::string file_ = (folder_.path() / "a.episodes").string();
};

TEST_F(Contradictions, BetweenColumnsAreDamage) {
  const std::string damaged = "the file is damaged: ";
  EXPECT_EQ(TimelineAfter("SELECT 1"), "");
  EXPECT_EQ(TimelineAfter("UPDATE episode SET status = 'weird'"),
            damaged + "found the status 'weird'");
  EXPECT_EQ(TimelineAfter("UPDATE event SET begin_s = 0.5 WHERE id = 1"),
            damaged + "'contact' is 0.5 s where it is tick 2");
  EXPECT_EQ(
      TimelineAfter("WITH RECURSIVE n(i) AS (VALUES(10) UNION ALL SELECT i + 1 FROM n WHERE i "
                    "< 99999) INSERT INTO event_role SELECT 1, i, 'x' || i, 'x', NULL FROM n"),
      damaged + "an event has more than 8 roles");
}

TEST_F(Contradictions, BetweenTicksAndFramesAreDamage) {
  const std::string damaged = "episode 1 (long/a_table_is_set_for_two): the file is damaged: ";
  const auto found = [&](int frames, int tick, int ticks = 2479) {
    return fmt::format("{}it has {} frames up to tick {}, wanted one of each of {} ticks", damaged,
                       frames, tick, ticks);
  };
  EXPECT_EQ(FramesAfter("SELECT 1"), "");
  EXPECT_EQ(FramesAfter("DELETE FROM chunk"), found(0, 0));
  EXPECT_EQ(FramesAfter("DELETE FROM chunk WHERE first_tick = 1"), found(1999, 2479));
  EXPECT_EQ(FramesAfter("DELETE FROM chunk WHERE first_tick = 481"), found(560, 2479));
  EXPECT_EQ(FramesAfter("DELETE FROM chunk WHERE first_tick = 2400"), found(2399, 2399));
  EXPECT_EQ(FramesAfter("UPDATE chunk SET last_tick = last_tick + 5"), found(2479, 2484));
  EXPECT_EQ(FramesAfter("UPDATE episode SET ticks = 2000"), found(2479, 2479, 2000));
  EXPECT_EQ(FramesAfter("SELECT 1", 240), damaged + "found the number 480, wanted 240 to 240");
}

TEST_F(Contradictions, WhatAnotherProcessWritesIsNeverCutOff) {
  After("SELECT 1");
  const pid_t writer = fork();
  if (writer == 0) {
    const Database database = OpenToWrite(file_);
    const std::string bytes(200'000,
                            'x');  // many pages behind the one that says how many there are
    for (int i = 0; i < 60; ++i) {
      Transaction transaction(database);
      Statement add = database.Prepare("INSERT INTO part VALUES(NULL, 9, 0, ?, ?)");
      add.Bind(i).BindBytes(bytes).Run();
      transaction.Commit();
    }
    _exit(0);
  }
  int status = -1;
  while (waitpid(writer, &status, WNOHANG) == 0) EXPECT_EQ(MessageOf(EpisodeFile::Open(file_)), "");
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace prehend::episode
