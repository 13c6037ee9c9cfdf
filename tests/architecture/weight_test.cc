// SPDX-License-Identifier: Apache-2.0
// What the program weighs: lines of the product, in sum and in each inner room, have a ceiling.
// What goes above pays by removing something; whoever removes lowers the ceiling. Python over the
// package has a ceiling of its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "tests/architecture/source_tree.h"

namespace prehend::architecture {
namespace {

namespace fs = std::filesystem;

constexpr long kMostLines = 118'773;
constexpr long kMostLinesOfPython = 5'360;
constexpr long kMostLinesPerRoom = 3500;

using Languages = std::set<std::string>;

/// Of the product, by folder; what npm installs is not ours.
std::map<std::string, long> LinesByRoom(const Languages& languages) {
  std::map<std::string, long> lines;
  for (const char* top : {"grammar", "harness", "physics", "render", "python"}) {
    const fs::path folder = fs::path(PREHEND_SOURCE_DIR) / top;
    if (!fs::exists(folder)) continue;
    for (fs::recursive_directory_iterator entry(folder), end; entry != end; ++entry) {
      if (entry->path().filename() == "node_modules") entry.disable_recursion_pending();
      if (!languages.contains(entry->path().extension())) continue;
      const std::string room =
          fs::relative(entry->path().parent_path(), PREHEND_SOURCE_DIR).generic_string();
      lines[room] += std::ranges::count(Slurp(entry->path()), '\n');
    }
  }
  return lines;
}

/// Printed, by wing.
long SumOf(const char* what, const Languages& languages, long most) {
  std::map<std::string, long> by_top;
  long sum = 0;
  for (const auto& [room, lines] : LinesByRoom(languages)) {
    by_top[room.substr(0, room.find('/'))] += lines;
    sum += lines;
  }
  std::printf("%s: %ld lines, at most %ld\n", what, sum, most);
  for (const auto& [top, lines] : by_top) std::printf("  %s: %ld\n", top.c_str(), lines);
  return sum;
}

const Languages kProgram = {".cc", ".h", ".js", ".mjs", ".pl"}, kPython = {".py", ".pyi"};

TEST(Weight, IsBelowItsCeiling) {
  const long program = SumOf("program", kProgram, kMostLines);
  EXPECT_GT(program, 50'000) << "the source tree was not found";
  EXPECT_LE(program, kMostLines) << "remove as much as you add, or make it smaller";
  EXPECT_LE(SumOf("Python", kPython, kMostLinesOfPython), kMostLinesOfPython);
}

TEST(Weight, OfARoomIsBelowItsCeiling) {
  for (const auto& [room, lines] : LinesByRoom(kProgram))
    EXPECT_LE(lines, kMostLinesPerRoom) << room;
}

}  // namespace
}  // namespace prehend::architecture
