// SPDX-License-Identifier: Apache-2.0
// What is written appears whole, at the place that is meant, or not at all.
#include "harness/whole_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <thread>

namespace prehend::harness {
namespace {

namespace fs = std::filesystem;

std::string Read(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class WholeFileTest : public testing::Test {
 protected:
  WholeFileTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~WholeFileTest() override { fs::remove_all(folder_); }

  std::size_t FilesInFolder() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), {}));
  }

  const fs::path folder_ =
      fs::path(testing::TempDir()) /
      ("whole_file_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(WholeFileTest, AppearsAtTheEndOrNotAtAll) {
  const fs::path path = folder_ / "a";
  ASSERT_EQ(WriteTextFile(path, "old"), "");
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
  {
    WholeFile file(path);
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

TEST_F(WholeFileTest, LinksStayLinks) {
  fs::create_directories(folder_ / "there");
  ASSERT_EQ(WriteTextFile(folder_ / "there/a", "old"), "");
  fs::create_symlink("there/a", folder_ / "link");
  fs::create_symlink("link", folder_ / "link_to_link");
  ASSERT_EQ(WriteTextFile(folder_ / "link_to_link", "new"), "");
  EXPECT_EQ(Read(folder_ / "there/a"), "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link_to_link"));

  fs::create_symlink("there/not_yet", folder_ / "ahead");
  ASSERT_EQ(WriteTextFile(folder_ / "ahead", "first"), "");
  EXPECT_EQ(Read(folder_ / "there/not_yet"), "first");

  fs::create_symlink("circle", folder_ / "circle");
  EXPECT_NE(WriteTextFile(folder_ / "circle", "x").find("symbolic links"), std::string::npos);
  EXPECT_TRUE(fs::is_symlink(folder_ / "circle"));
}

TEST_F(WholeFileTest, DevicesStayDevices) {
  fs::create_symlink("/dev/null", folder_ / "null");
  fs::create_symlink("/dev/full", folder_ / "full");
  EXPECT_EQ(WriteTextFile(folder_ / "null", "x"), "");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_EQ(WriteTextFile(folder_ / "full", "x"),
            "cannot write " + (folder_ / "full").string() + ": No space left on device");
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
  EXPECT_EQ(WhyNotWritable(folder_ / "full"), "") << "only writing tells";
  EXPECT_EQ(FilesInFolder(), 2u);
}

TEST_F(WholeFileTest, PipesAreWrittenTo) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(WhyNotWritable(pipe), "") << "nobody reads yet, and nobody waits";
  std::string read;
  std::thread reader([&] { read = Read(pipe); });
  EXPECT_EQ(WriteTextFile(pipe, "through"), "");
  reader.join();
  EXPECT_EQ(read, "through");
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(WholeFileTest, WhatCannotBeWrittenIsKnownBefore) {
  EXPECT_EQ(WhyNotWritable(folder_), folder_.string() + " is a folder");
  EXPECT_EQ(WhyNotWritable(folder_ / "new/folders/a"), "");
  EXPECT_TRUE(fs::is_directory(folder_ / "new/folders"));
  EXPECT_TRUE(fs::is_empty(folder_ / "new/folders"));
  ASSERT_EQ(WriteTextFile(folder_ / "a", "x"), "");
  EXPECT_NE(WhyNotWritable(folder_ / "a/b"), "");
  EXPECT_NE(WhyNotWritable("/proc/nothing_can_be_made_here"), "");
  EXPECT_NE(WhyNotWritable(""), "");
}

}  // namespace
}  // namespace prehend::harness
