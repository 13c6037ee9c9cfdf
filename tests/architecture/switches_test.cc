// SPDX-License-Identifier: Apache-2.0
// A switch over an enum of ours has no `default`: the compiler names what a new enumerator lacks.
// Enumerators are recognised by their names, kLikeThis.
#include <gtest/gtest.h>

#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/architecture/source_tree.h"

namespace prehend::architecture {
namespace {

/// The numbers of the lines with such a `default`. Labels of a switch are at the same depth.
std::vector<int> DefaultsIn(const std::string& text) {
  static const std::regex kOfAnEnum(
      R"(\s*case (\w+::)*k[A-Z]\w*:.*|\s*PREHEND_\w+\(PREHEND_CASE\))");
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  std::vector<int> found;
  for (std::size_t at = 0; at < lines.size(); ++at) {
    const std::size_t depth = lines[at].find_first_not_of(' ');
    if (depth == std::string::npos || !lines[at].substr(depth).starts_with("default:")) continue;
    bool of_an_enum = false;
    for (std::size_t above = at; above-- > 0 && !of_an_enum;) {
      const std::size_t indent = lines[above].find_first_not_of(' ');
      if (indent == std::string::npos) continue;
      if (indent < depth) break;  // the head of the switch
      of_an_enum = indent <= depth + 2 && std::regex_match(lines[above], kOfAnEnum);
    }
    if (of_an_enum) found.push_back(static_cast<int>(at) + 1);
  }
  return found;
}

TEST(Switches, OverEnumsAreToldFromOthers) {
  EXPECT_EQ(DefaultsIn("  switch (op) {\n"
                       "    case Op::kAnd:\n"
                       "      return 1;\n"
                       "    default:\n"
                       "      return 0;\n"
                       "  }\n"),
            std::vector<int>{4});
  EXPECT_EQ(DefaultsIn("  switch (op) {\n"
                       "    case kNear: {\n"
                       "      switch (letter) {\n"
                       "        case 'a':\n"
                       "          break;\n"
                       "        default:\n"
                       "          break;\n"
                       "      }\n"
                       "    }\n"
                       "    case kFar:\n"
                       "      break;\n"
                       "  }\n"),
            std::vector<int>{});
}

TEST(Switches, OverEnumsHaveNoDefault) {
  for (const SourceFile& file : SourceFiles({"grammar", "harness", "physics", "render"})) {
    for (const int line : DefaultsIn(file.text))
      ADD_FAILURE() << file.path << ":" << line
                    << ": a 'default' hides what a new enumerator lacks; list the others";
  }
}

}  // namespace
}  // namespace prehend::architecture
