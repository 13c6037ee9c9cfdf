// SPDX-License-Identifier: Apache-2.0
// docs/script-cookbook.md: each scenario on the page is read and played, and could be accepted.
#include <gtest/gtest.h>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;

/// The YAML blocks of a page that are whole scenarios, by name.
std::vector<std::pair<std::string, std::string>> ScenariosOn(const fs::path& page) {
  constexpr std::string_view kBegin = "```yaml\nscenario: ", kEnd = "\n```";
  const std::string text = ReadFile(page);
  std::vector<std::pair<std::string, std::string>> found;
  for (std::size_t at = text.find(kBegin); at != std::string::npos; at = text.find(kBegin, at)) {
    const std::size_t begin = at + std::string_view("```yaml\n").size();
    at = text.find(kEnd, begin);
    const std::string block = text.substr(begin, at - begin + 1);
    const std::size_t name = std::string_view("scenario: ").size();
    found.emplace_back(block.substr(name, block.find('\n') - name), block);
  }
  return found;
}

/// `accept` refuses events that are others after a transform.
TEST(Cookbook, EachScenarioCouldBeAccepted) {
  const fs::path folder = FreshFolder("cookbook");
  WriteFile(folder / "prehend.yaml", "");
  const auto scenarios = ScenariosOn(fs::path(PREHEND_SOURCE_DIR) / "docs/script-cookbook.md");
  EXPECT_GE(scenarios.size(), 10u);
  for (const auto& [name, text] : scenarios)
    WriteFile(folder / "scenarios/cookbook" / (name + ".yaml"), text);
  const std::string in_folder = "unset PREHEND_HOME && cd '" + folder.string() + "'";
  const Said checked = Prehend({"check", "--no-pictures"}, {"CI="}, in_folder);
  EXPECT_EQ(checked.exit_code, 5) << "pending, and no claim is wrong\n"
                                  << checked.out << checked.err;
  EXPECT_EQ(checked.out.find("failed  "), std::string::npos) << checked.out;
  EXPECT_EQ(checked.out.find("note: "), std::string::npos) << checked.out;
  for (const auto& [name, text] : scenarios) {
    const Said accepted = Prehend({"accept", name, "--reason", "docs"}, {"CI="}, in_folder);
    EXPECT_EQ(accepted.exit_code, 0) << accepted.out << accepted.err;
  }
  fs::remove_all(folder);
}

/// So that a script of one page can be watched by a grammar of the other.
TEST(Cookbook, EachGrammarJoinsPickAndPlace) {
  const fs::path folder = FreshFolder("cookbook");
  WriteFile(folder / "prehend.yaml", "");
  constexpr std::string_view kBegin = "```\ngrammar ", kEnd = "```";
  const std::string text = ReadFile(fs::path(PREHEND_SOURCE_DIR) / "docs/cookbook.md");
  int count = 0;
  for (std::size_t at = text.find(kBegin); at != std::string::npos; at = text.find(kBegin, at)) {
    const std::size_t begin = at + kBegin.size();
    at = text.find(kEnd, begin);
    const std::string name = text.substr(begin, text.find('\n', begin) - begin);
    WriteFile(folder / (name + ".grammar"), "grammar " + text.substr(begin, at - begin));
    WriteFile(folder / ("with_" + name + ".yaml"),
              "scenario: with_" + name + "\nshows: two grammars\ngrammar: [pick_and_place, ./" +
                  name +
                  ".grammar]\nentities:\n  ball: {sphere: {radius_m: 0.03}, mass_kg: 0.1, "
                  "at_m: [0, 0, 0.5]}\n");
    const Said said = Prehend({"validate", "with_" + name + ".yaml"}, {"CI="},
                              "unset PREHEND_HOME && cd '" + folder.string() + "'");
    EXPECT_EQ(said.exit_code, 0) << said.err;
    ++count;
  }
  EXPECT_GE(count, 9);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace prehend::house
