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
  const std::string names = "(episodes|recordings|grammars|programs|settings|labels)";
  std::vector<std::string> found;
  for (const std::string& form : {"for \\([^;{)]*: \\*?" + names + "\\)",
                                  "for \\([^;{]*;[^;{]*\\b" + names + "(\\.|->)size"}) {
    const std::regex loop(form);
    for (std::sregex_iterator at(text.begin(), text.end(), loop), end; at != end; ++at)
      found.push_back(at->str());
  }
  return found;
}

TEST(Commands, DoNotCompute) {
  for (const SourceFile& file : SourceFiles({"harness/cli"})) {
    for (const std::string& loop : LoopsThatCompute(file.text))
      ADD_FAILURE() << file.path << ": '" << loop << "' belongs into a room that others may use";
  }
}

TEST(Commands, ALoopThatComputesIsFound) {
  const std::string range = "for (const Episode& episode : episodes)",
                    count = "for (std::size_t g = 0; g < grammars.size";
  EXPECT_EQ(LoopsThatCompute(range + " {\n  a;\n}\n"), std::vector<std::string>{range});
  EXPECT_EQ(LoopsThatCompute(count + "(); ++g) {\n}\n"), std::vector<std::string>{count});
  EXPECT_TRUE(LoopsThatCompute("for (const Line& line : lines) Print(labels, line);\n").empty());
}

}  // namespace
}  // namespace prehend::architecture
