// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>

#include "harness/base/base/atomic_file.h"

namespace prehend {
namespace {

namespace fs = std::filesystem;

TEST(TemporaryFolder, IsOnesOwnAndGoesWithWhatIsInIt) {
  fs::path path;
  {
    const TemporaryFolder one, other;
    path = one.path();
    EXPECT_TRUE(fs::is_directory(path));
    EXPECT_NE(path, other.path());
    EXPECT_EQ(one.problem(), "");
    std::ofstream(path / "file") << "x";
  }
  EXPECT_FALSE(fs::exists(path));
}

TEST(TemporaryFolder, OfAProcessThatWasKilledIsRemoved) {
  const TemporaryFolder own;
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t killed = fork();
  if (killed == 0) {
    const TemporaryFolder left;
    fs::create_directories(left.path() / "a/b/c");
    std::ofstream(left.path() / "a/b/c/file") << "x";
    const std::string path = left.path().string();
    (void)!write(ends[1], path.data(), path.size());
    raise(SIGKILL);
  }
  std::string path(4096, '\0');
  path.resize(static_cast<std::size_t>(std::max<ssize_t>(0, read(ends[0], path.data(), 4096))));
  ASSERT_EQ(waitpid(killed, nullptr, 0), killed);
  EXPECT_TRUE(fs::exists(path + "/a/b/c/file")) << path;
  RemoveLeftFolders();
  EXPECT_FALSE(fs::exists(path));
  EXPECT_TRUE(fs::exists(own.path())) << "its process lives";
  close(ends[0]);
  close(ends[1]);
}

TEST(TemporaryFolder, SaysWhyThereIsNone) {
  const char* const before = std::getenv("TMPDIR");
  const std::string kept = before ? before : "";
  setenv("TMPDIR", "/dev/null/nowhere", 1);
  const TemporaryFolder none;
  if (before)
    setenv("TMPDIR", kept.c_str(), 1);
  else
    unsetenv("TMPDIR");
  EXPECT_EQ(none.problem(), "no folder for temporary files: Not a directory");
  EXPECT_TRUE(none.path().empty());
}

}  // namespace
}  // namespace prehend
