// SPDX-License-Identifier: Apache-2.0
// What is written appears whole, at the place that is meant, or not at all.
#include "harness/base/base/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>

#include "harness/base/base/input_files.h"
#include "harness/base/process/worker_pool.h"

namespace prehend {
namespace {

namespace fs = std::filesystem;

std::string Read(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class AtomicFileTest : public testing::Test {
 protected:
  AtomicFileTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~AtomicFileTest() override { fs::remove_all(folder_); }

  std::size_t FilesInFolder() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), {}));
  }

  std::string Cannot(const std::string& name, const std::string& why) const {
    return "cannot write " + (folder_ / name).string() + ": " + why;
  }

  const fs::path folder_ =
      fs::path(testing::TempDir()) /
      ("atomic_file_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(AtomicFileTest, AppearsAtTheEndOrNotAtAll) {
  const fs::path path = folder_ / "a";
  ASSERT_EQ(WriteTextFile(path, "old"), "");
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
  {
    AtomicFile file(path);
    file.stream() << "half of what";
    EXPECT_EQ(Read(path), "old");
  }
  EXPECT_EQ(Read(path), "old");
  EXPECT_EQ(FilesInFolder(), 1u);
  const std::string large(1'000'000, 'x');
  ASSERT_EQ(WriteTextFile(path, large), "");
  EXPECT_EQ(Read(path), large);
  EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(FilesInFolder(), 1u);
}

TEST_F(AtomicFileTest, NothingIsSeenBeforeTheEnd) {
  const int nameless = open(folder_.c_str(), O_TMPFILE | O_WRONLY, 0600);
  if (nameless < 0) GTEST_SKIP() << "this file system has no files without a name";
  close(nameless);
  AtomicFile file(folder_ / "a");
  file.stream() << std::string(100'000, 'x') << std::flush;
  EXPECT_EQ(FilesInFolder(), 0u) << "a killed process leaves nothing behind";
  EXPECT_EQ(file.Commit(), "");
  EXPECT_EQ(Read(folder_ / "a"), std::string(100'000, 'x'));
  EXPECT_EQ(FilesInFolder(), 1u);
  EXPECT_EQ(file.Commit().substr(0, 12), "cannot write") << "once only";
}

/// Files of this process may not grow beyond `bytes`, as on a disk that is full.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int) = std::signal(SIGXFSZ, SIG_IGN);
};

TEST_F(AtomicFileTest, WhenTheDiskIsFullTheOldFileIsAsItWas) {
  ASSERT_EQ(WriteTextFile(folder_ / "a", "old"), "");
  const std::string why = "not all of it could be written; is the disk full?";
  {
    const FullDisk disk(1000);
    EXPECT_EQ(WriteTextFile(folder_ / "a", std::string(1'000'000, 'x')), Cannot("a", why));
    EXPECT_EQ(WriteTextFile(folder_ / "a", std::string(1001, 'x')), Cannot("a", why));
    EXPECT_EQ(WriteTextFile(folder_ / "b", std::string(1000, 'x')), "");
  }
  EXPECT_EQ(Read(folder_ / "a"), "old");
  EXPECT_EQ(FilesInFolder(), 2u);
}

TEST_F(AtomicFileTest, LinksStayLinks) {
  fs::create_directories(folder_ / "there");
  ASSERT_EQ(WriteTextFile(folder_ / "there/a", "old"), "");
  fs::create_symlink("there/a", folder_ / "link");
  fs::create_symlink("link", folder_ / "link_to_link");
  ASSERT_EQ(WriteTextFile(folder_ / "link_to_link", "new"), "");
  EXPECT_EQ(Read(folder_ / "there/a"), "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link_to_link"));
  fs::create_symlink("there", folder_ / "linked_folder");
  ASSERT_EQ(WriteTextFile(folder_ / "linked_folder/b", "new"), "");
  EXPECT_EQ(Read(folder_ / "there/b"), "new");
}

TEST_F(AtomicFileTest, ALinkToNothingIsRefused) {
  const std::string why = "it is a link to a file that does not exist";
  fs::create_symlink("not_yet", folder_ / "ahead");
  EXPECT_EQ(WriteTextFile(folder_ / "ahead", "x"), Cannot("ahead", why));
  fs::create_symlink("circle", folder_ / "circle");
  EXPECT_EQ(WriteTextFile(folder_ / "circle", "x"), Cannot("circle", why));
  EXPECT_TRUE(fs::is_symlink(folder_ / "ahead"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "circle"));
  EXPECT_EQ(FilesInFolder(), 2u);
}

TEST_F(AtomicFileTest, DevicesAndPipesAreNotReplacedByFiles) {
  const std::string why =
      "it is a device or a pipe, wanted a file; standard output is written as '-'";
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  fs::create_symlink("/dev/null", folder_ / "null");
  EXPECT_EQ(WriteTextFile(pipe, "x"), Cannot("pipe", why));
  EXPECT_EQ(WhyNotWritable(pipe), Cannot("pipe", why)) << "and nobody waits for a reader";
  EXPECT_EQ(WriteTextFile(folder_ / "null", "x"), Cannot("null", why));
  EXPECT_EQ(WriteTextFile("/dev/full", "x"), "cannot write /dev/full: " + why);
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const std::string substituted = "/dev/fd/" + std::to_string(ends[1]);
  EXPECT_EQ(WriteTextFile(substituted, "x"), "cannot write " + substituted + ": " + why);
  close(ends[0]);
  close(ends[1]);
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
  EXPECT_EQ(FilesInFolder(), 2u);
}

TEST_F(AtomicFileTest, AnOutputOfTheProgramIsNotReplacedByAFile) {
  const fs::path path = folder_ / "redirected";
  std::fflush(stdout);
  const int before = dup(STDOUT_FILENO);
  ASSERT_NE(std::freopen(path.c_str(), "w", stdout), nullptr);
  const std::string by_name = WriteTextFile(path, "x");
  const std::string by_device = WriteTextFile("/dev/stdout", "x");
  std::fflush(stdout);
  dup2(before, STDOUT_FILENO);
  close(before);
  const std::string why =
      "it is an output of this program, wanted a file; standard output is written as '-'";
  EXPECT_EQ(by_name, Cannot("redirected", why));
  EXPECT_EQ(by_device, "cannot write /dev/stdout: " + why);
}

TEST_F(AtomicFileTest, ADashIsStandardOutput) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(WriteTextFile("-", "through"), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "through");
  EXPECT_EQ(WhyNotWritable("-"), "");
}

TEST_F(AtomicFileTest, WhatCannotBeWrittenIsKnownBefore) {
  EXPECT_EQ(WhyNotWritable(folder_), "cannot write " + folder_.string() + ": it is a folder");
  EXPECT_EQ(WhyNotWritable(folder_ / "new/folders/a"), "");
  EXPECT_TRUE(fs::is_directory(folder_ / "new/folders"));
  EXPECT_TRUE(fs::is_empty(folder_ / "new/folders"));
  ASSERT_EQ(WriteTextFile(folder_ / "a", "x"), "");
  EXPECT_EQ(WhyNotWritable(folder_ / "a/b"),
            "cannot create " + (folder_ / "a").string() + ": Not a directory");
  EXPECT_EQ(WhyNotWritable("/proc/nothing_can_be_made_here"),
            "cannot write /proc/nothing_can_be_made_here: No such file or directory");
  EXPECT_EQ(WhyNotWritable(""), "cannot write : it names no file");
  EXPECT_EQ(WhyNotWritable(folder_ / "new/"),
            "cannot write " + (folder_ / "new/").string() + ": it is a folder");
}

TEST_F(AtomicFileTest, AnInputIsNotReplaced) {
  const fs::path input = folder_ / "a", link = folder_ / "soft", hard = folder_ / "hard";
  ASSERT_EQ(WriteTextFile(input, "old"), "");
  fs::create_symlink("a", link);
  fs::create_hard_link(input, hard);
  AtomicFile begun(input);
  EXPECT_TRUE(OpenInput(input.string()));
  for (const fs::path& path : {input, link, hard, folder_ / "." / "a"})
    EXPECT_EQ(WriteTextFile(path, "new"),
              "cannot write " + path.string() + ": it is what is read; name another file");
  begun.stream() << "new";
  EXPECT_EQ(begun.Commit(), Cannot("a", "it is what is read; name another file"))
      << "read after it was opened";
  EXPECT_EQ(Read(input), "old");
  EXPECT_EQ(WriteTextFile(input, "new", Over::kAnything), "");
  EXPECT_EQ(WriteTextFile(input, "newer"), "") << "what was read is not there any more";
  EXPECT_EQ(WriteTextFile(folder_ / "b", "new"), "");
}

TEST_F(AtomicFileTest, AnInputOfAWorkerIsOne) {
  const fs::path one = folder_ / "one", two = folder_ / "two", no = folder_ / "no";
  for (const fs::path& path : {one, two, no}) ASSERT_EQ(WriteTextFile(path, "old"), "");
  const std::vector<WorkerResult> results = RunInWorkers({[&] {
                                                            OpenInput(one.string());
                                                            OpenInput(two.string());
                                                            return std::string("\0said", 5);
                                                          },
                                                          [] { return std::string(); }},
                                                         {});
  EXPECT_EQ(results[0].output, std::string("\0said", 5));
  EXPECT_EQ(results[1].output, "");
  EXPECT_TRUE(IsInput(one) && IsInput(two));
  EXPECT_FALSE(IsInput(no));
}

}  // namespace
}  // namespace prehend
