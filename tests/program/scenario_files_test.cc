// SPDX-License-Identifier: Apache-2.0
// The scenario files of the project themselves: editors find the schema, and each of the invalid
// ones is refused with the text that stands beside it.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;

const fs::path kScenarios = fs::path(PREHEND_SOURCE_DIR) / "scenarios";

std::vector<fs::path> FilesBelow(const fs::path& folder, const std::string& ending) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == ending) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

/// A hand or grasps, which scenarios use.
bool IsOfAHand(const fs::path& file) {
  return file.string().ends_with(".hand.yaml") || file.string().ends_with(".grasps.yaml");
}

/// What `new` makes scenarios and projects of.
bool IsTemplate(const fs::path& file) {
  return file.string().starts_with((kScenarios / "templates/").string());
}

TEST(ScenarioFiles, BeginWithTheLineThatEditorsLookFor) {
  const auto files = FilesBelow(kScenarios, ".yaml");
  ASSERT_GE(files.size(), 40u);
  for (const fs::path& file : files) {
    if (fs::file_size(file) == 0 || IsOfAHand(file) || IsTemplate(file)) continue;
    const std::string text = ReadFile(file);
    EXPECT_EQ(text.substr(0, text.find('\n')),
              "# yaml-language-server: $schema=../scenario.schema.json")
        << file;
  }
  EXPECT_EQ(Prehend({"scenario", "schema"}).out, ReadFile(kScenarios / "scenario.schema.json"))
      << "renew it with: prehend scenario schema > scenarios/scenario.schema.json";
}

std::vector<std::string> InvalidNames() {
  std::vector<std::string> names;
  for (const fs::path& file : FilesBelow(kScenarios / "invalid", ".yaml")) {
    if (!IsOfAHand(file)) names.push_back(file.stem().string());
  }
  return names;
}

class InvalidScenario : public testing::TestWithParam<std::string> {};

TEST_P(InvalidScenario, IsRefusedWithTheTextBesideIt) {
  const std::string file = "scenarios/invalid/" + GetParam() + ".yaml";
  const std::string expected = ReadFile(kScenarios / "invalid" / (GetParam() + ".error"));
  const Said said = Prehend({"validate", file});  // runs in the source tree
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_EQ(said.out, "");
  EXPECT_EQ(said.err, expected + "  again: prehend validate " + file + "\n");
  EXPECT_EQ(Prehend({"run", file}).err, expected + "  again: prehend run " + file + "\n");
}

INSTANTIATE_TEST_SUITE_P(All, InvalidScenario, testing::ValuesIn(InvalidNames()),
                         [](const auto& row) { return row.param; });

TEST(InvalidScenarios, AreManyKindsEachWithItsText) {
  std::set<std::string> texts;
  for (const std::string& name : InvalidNames())
    texts.insert(ReadFile(kScenarios / "invalid" / (name + ".error")));
  EXPECT_GE(texts.size(), 25u);
  EXPECT_EQ(FilesBelow(kScenarios / "invalid", ".error").size(), InvalidNames().size());
}

TEST(InvalidScenarios, AreNoPartOfTheSuite) {
  EXPECT_EQ(Prehend({"list"}).out.find("invalid/"), std::string::npos);
  EXPECT_EQ(Prehend({"check", "invalid/*"}).exit_code, 4);
}

}  // namespace
}  // namespace prehend::house
