// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

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
