// SPDX-License-Identifier: Apache-2.0
// A function is read in one piece: at most kMostLinesOfFunction, a command less. What is laid out
// by clang-format ends with a '}' alone in its line, below the first character of its head.
#include <gtest/gtest.h>

#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "tests/architecture/source_tree.h"

namespace prehend::architecture {
namespace {

constexpr int kMostLinesOfFunction = 80;
/// Of a command, since what computes lies in other rooms.
constexpr int kMostLinesOfCommands = 60;
constexpr const char* kCommands = "harness/cli/";

/// A function that returns a Command is a table.
constexpr const char* kTableOfOptions = "Command ";

struct Block {
  int line = 0;  ///< of its head, counts from 1
  int lines = 0;
  std::string head;
};

std::optional<std::size_t> IndentOf(const std::string& line) {
  const std::size_t indent = line.find_first_not_of(' ');
  return indent == std::string::npos ? std::nullopt : std::optional(indent);
}

/// The longest block that ends with a '}' alone: a function, as what is in it is shorter.
Block LongestIn(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  Block longest;
  for (std::size_t end = 0; end < lines.size(); ++end) {
    const auto indent = IndentOf(lines[end]);
    if (!indent || lines[end].substr(*indent) != "}") continue;
    std::size_t begin = end;
    while (begin > 0) {
      const auto above = IndentOf(lines[--begin]);
      if (above && *above <= *indent && lines[begin][*above] != '#') break;
    }
    const int count = static_cast<int>(end - begin) + 1;
    if (count > longest.lines && !lines[begin].starts_with(kTableOfOptions))
      longest = {static_cast<int>(begin) + 1, count, lines[begin]};
  }
  return longest;
}

TEST(FunctionLength, IsThatOfTheLongestFunction) {
  const Block longest = LongestIn(
      "namespace a {\n"
      "int Short() { return 1; }\n"
      "int Long(int a,\n"
      "         int b) {\n"
      "  if (a) {\n"
      "    return b;\n"
      "  }\n"
      "\n"
      "  return a;\n"
      "}\n"
      "Command Table() {\n  return {\n    1,\n    2,\n    3,\n    4,\n    5,\n    6};\n}\n"
      "struct S {\n"
      "  int a = 0;\n"
      "};\n"
      "}  // namespace a\n");
  EXPECT_EQ(longest.lines, 8);
  EXPECT_EQ(longest.line, 3);
  EXPECT_EQ(longest.head, "int Long(int a,");
}

TEST(FunctionLength, FitsOnAScreenOutsideOfTables) {
  for (const SourceFile& file : SourceFiles({"grammar", "harness", "physics", "render"})) {
    const int most = file.path.starts_with(kCommands) ? kMostLinesOfCommands : kMostLinesOfFunction;
    const Block longest = LongestIn(file.text);
    EXPECT_LE(longest.lines, most) << file.path << ":" << longest.line << ": " << longest.head;
  }
}

}  // namespace
}  // namespace prehend::architecture
