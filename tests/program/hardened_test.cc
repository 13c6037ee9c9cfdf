// SPDX-License-Identifier: Apache-2.0
// What docs/security.md says of the build, read from the program itself: position-independent,
// relocations read-only and bound at the start, no page both writable and run; the readers with
// stack protector, checked copies and checked containers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

/// What readelf says of the program.
std::string Readelf(const std::string& options) {
  const std::filesystem::path printed = FreshFolder("readelf") / "printed";
  const std::string command =
      "readelf " + options + " '" PREHEND_BINARY_DIR "/prehend' >'" + printed.string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0);
  return ReadFile(printed);
}

TEST(Hardened, TheProgramIsAsDocumented) {
  EXPECT_THAT(Readelf("-hW"), ContainsRegex("Type: +DYN"));
  EXPECT_THAT(Readelf("-dW"), ContainsRegex("FLAGS_1.* NOW.*PIE"));
  std::istringstream segments(Readelf("-lW"));
  bool read_only_relocations = false;
  for (std::string line; std::getline(segments, line);) {
    read_only_relocations |= line.find("GNU_RELRO") != std::string::npos;
    EXPECT_EQ(line.find(" RWE "), std::string::npos) << line;
  }
  EXPECT_TRUE(read_only_relocations);
  const std::string called = Readelf("-W --dyn-syms");
  for (const char* check : {"__stack_chk_fail", "__memcpy_chk", "__glibcxx_assert_fail"})
    EXPECT_THAT(called, HasSubstr(check));
}

}  // namespace
}  // namespace prehend::house
