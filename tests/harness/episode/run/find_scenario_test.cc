// SPDX-License-Identifier: Apache-2.0
#include "harness/episode/run/find_scenario.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "harness/base/base/project_paths.h"

namespace prehend::episode {
namespace {

class LibraryPaths : public testing::Test {
 protected:
  void SetUp() override {
    root_ =
        std::filesystem::path(testing::TempDir()) / ("library_paths_" + std::to_string(getpid()));
    for (const char* file :
         {"scenarios/lift/cup_is_lifted.yaml", "scenarios/lift/both.yaml",
          "scenarios/slide/both.yaml", "scenarios/alone.yaml", "scenarios/invalid/typo.yaml",
          "scenarios/templates/carry.yaml", "scenarios/lift/notes.txt",
          "scenarios/lift/my.hand.yaml", "scenarios/lift/my.grasps.yaml",
          "grammar/library/b.grammar", "grammar/library/a.grammar",
          "physics/library/human_right.hand.yaml"}) {
      std::filesystem::create_directories((root_ / file).parent_path());
      std::ofstream(root_ / file) << "x\n";
    }
  }
  void TearDown() override { std::filesystem::remove_all(root_); }

  std::filesystem::path root_;
};

TEST_F(LibraryPaths, ScenariosAreListedSorted) {
  std::string all;
  for (const auto& scenario : ListScenarios(root_))
    all += scenario.skill + "/" + scenario.name + " ";
  EXPECT_EQ(all, "/alone lift/both lift/cup_is_lifted slide/both ");
}

TEST_F(LibraryPaths, ScenariosAreFoundByNameSkillOrPath) {
  const auto scenarios = ListScenarios(root_);
  const std::string cup = (root_ / "scenarios/lift/cup_is_lifted.yaml").string();
  EXPECT_EQ(FindScenario(scenarios, "cup_is_lifted"), cup);
  EXPECT_EQ(FindScenario(scenarios, "lift/cup_is_lifted"), cup);
  EXPECT_EQ(FindScenario(scenarios, cup), cup);
  EXPECT_EQ(FindScenario(scenarios, "slide/both"), (root_ / "scenarios/slide/both.yaml").string());
  EXPECT_EQ(FindScenario(scenarios, "both"), std::nullopt);
  EXPECT_EQ(FindScenario(scenarios, "nothing_like_it"), std::nullopt);
  EXPECT_EQ(FindScenario(scenarios, "not/there.yaml"), "not/there.yaml")
      << "the reader says that it is missing";
}

TEST_F(LibraryPaths, HintsForNames) {
  const auto scenarios = ListScenarios(root_);
  EXPECT_EQ(HintForScenario(scenarios, "cup_is_liftd"), "did you mean 'cup_is_lifted'?");
  EXPECT_EQ(HintForScenario(scenarios, "slide/cup_is_lifted"), "did you mean 'cup_is_lifted'?");
  EXPECT_EQ(HintForScenario(scenarios, "lifted"), "did you mean 'cup_is_lifted'?")
      << "a part of it";
  EXPECT_EQ(HintForScenario(scenarios, "both"), "which one: lift/both, slide/both?");
  EXPECT_EQ(HintForScenario(scenarios, "something_else_entirely"), "");
}

TEST_F(LibraryPaths, TheLibraryListsGrammarsAndHands) {
  const scenario::ScenarioLibrary library = ProjectLibrary(root_);
  EXPECT_EQ(library.grammars, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(library.hands, (std::vector<std::string>{"human_right"}));
  EXPECT_FALSE(library.read_hand("human_right", {}));
}

TEST_F(LibraryPaths, TheRootIsThatOfTheEnvironmentOrAboveTheExecutable) {
  ASSERT_EQ(setenv("PREHEND_HOME", root_.c_str(), 1), 0);
  EXPECT_EQ(FindProjectRoot(), root_.string());
  ASSERT_EQ(unsetenv("PREHEND_HOME"), 0);
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(root_ / "scenarios" / "lift");
  const auto found =
      FindProjectRoot();  // above the test's binary, when it is built inside the project
  std::filesystem::current_path(before);
  ASSERT_TRUE(found);
  EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(*found) / "grammar/library"));
}

}  // namespace
}  // namespace prehend::episode
