// SPDX-License-Identifier: Apache-2.0
// A command reads options, asks a function of another room, and prints what that says. What has a
// loop over recordings, grammars or settings computes, and can be used by others elsewhere.
#include <gtest/gtest.h>

#include <regex>
#include <string>
#include <vector>

#include "tests/architecture/source_tree.h"

namespace prehend::architecture {
namespace {

/// The heads of loops that have no place in a command.
std::vector<std::string> LoopsThatCompute(const std::string& text) {
  std::vector<std::string> found;
  const std::regex loop(
      R"(for \([^{;]*[ *:](takes|recordings|grammars|programs|settings|labels)\b[^{]*)");
  for (std::sregex_iterator at(text.begin(), text.end(), loop), end; at != end; ++at)
    found.push_back(at->str());
  return found;
}

TEST(Commands, DoNotCompute) {
  for (const SourceFile& file : SourceFiles({"harness/cli"})) {
    for (const std::string& loop : LoopsThatCompute(file.text))
      ADD_FAILURE() << file.path << ": '" << loop << "' belongs into a room that others may use";
  }
}

TEST(Commands, ALoopThatComputesIsFound) {
  EXPECT_EQ(LoopsThatCompute("for (const Take& take : takes) {\n  a;\n}\n"),
            std::vector<std::string>{"for (const Take& take : takes) "});
  EXPECT_EQ(LoopsThatCompute("for (std::size_t g = 0; g < grammars.size(); ++g) {\n}\n").size(),
            1u);
  EXPECT_TRUE(LoopsThatCompute("for (const Line& line : lines) Print(takes, line);\n").empty());
}

}  // namespace
}  // namespace prehend::architecture
