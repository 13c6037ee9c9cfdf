// SPDX-License-Identifier: Apache-2.0
// The edge of a suite: files that look like scenarios and are not run, and scenarios that get
// another name.
#include <gtest/gtest.h>

#include "tests/program/small_project.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;

class SuiteEdge : public SmallProject {
 protected:
  void Stray(const std::string& file) const {
    WriteFile(root_ / file, Replaced(kCartonRests, "carton_rests", "stray"));
  }
};

TEST_F(SuiteEdge, FilesThatAreNotRunAreNamed) {
  Accept();
  const auto expect_named = [&](const std::string& file) {
    for (const char* command : {"check --no-pictures", "list", "validate"}) {
      const Said said = Do(command);
      EXPECT_EQ(said.exit_code, 0) << command << said.err;
      EXPECT_NE(said.err.find(file + ": warning: it is not run: scenarios end in .yaml, and lie in "
                                     "scenarios/ or scenarios/SKILL/\n"),
                std::string::npos)
          << command << said.err;
      const Said in_ci = Do(command, "true");
      EXPECT_EQ(in_ci.exit_code, 2) << command;
      EXPECT_NE(in_ci.err.find(file + ": error: it is not run"), std::string::npos) << in_ci.err;
    }
  };
  for (const char* file :
       {"scenarios/rest/a.yml", "scenarios/rest/A.YAML", "scenarios/rest/deep/b.yaml",
        "scenario/rest/c.yaml", "scenarios/d.yml"}) {
    Stray(file);
    expect_named(file);
    fs::remove(root_ / file);
  }
  // What is no scenario, and what is meant to lie there.
  WriteFile(root_ / "scenarios/rest/deep/notes.yaml", "notes: none\n");
  WriteFile(root_ / "scenarios/invalid/deep/x.yml", "scenario: x\n");
  EXPECT_EQ(Do("check --no-pictures", "true").err, "");
  // By name it is another question.
  Stray("scenarios/rest/a.yml");
  EXPECT_EQ(Do("check rest/carton_rests --no-pictures", "true").exit_code, 0);
}

TEST_F(SuiteEdge, AProjectOfOthersOnlyIsNoSuite) {
  fs::rename(Scenario(), root_ / "scenarios/rest/carton_rests.yml");
  const Said said = Do("check --no-pictures");
  EXPECT_NE(said.exit_code, 0);
  EXPECT_NE(said.err.find("carton_rests.yml: warning: it is not run"), std::string::npos);
}

TEST_F(SuiteEdge, ARenamedScenarioKeepsItsGoldenAndReasons) {
  Accept();
  WriteFile(root_ / "golden/rest/carton_rests.png", "a picture");
  WriteFile(root_ / "golden/rest/carton_rests-2.png", "another one");
  WriteFile(root_ / "golden/rest/carton_rests-2.things", "what it shows");
  const std::string golden = ReadFile(Golden());
  const Said said = Do("scenario rename carton_rests still/box_rests");
  ASSERT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(ReadFile(root_ / "golden/still/box_rests-2.things"), "what it shows");
  EXPECT_FALSE(fs::exists(root_ / "golden/rest/carton_rests-2.things"));
  EXPECT_NE(said.out.find("prehend accept still/box_rests --pictures"), std::string::npos)
      << said.out;
  EXPECT_FALSE(fs::exists(Scenario()));
  EXPECT_FALSE(fs::exists(Golden()));
  EXPECT_EQ(ReadFile(Golden("still/box_rests")),
            Replaced(golden, "# scenario: rest/carton_rests", "# scenario: still/box_rests"));
  EXPECT_NE(golden.find("nothing_happens"), std::string::npos) << "its reason";
  EXPECT_EQ(ReadFile(root_ / "golden/still/box_rests-2.png"), "another one");
  fs::remove(root_ / "golden/still/box_rests.png");
  fs::remove(root_ / "golden/still/box_rests-2.png");
  const Said checked = Do("check --no-pictures");
  EXPECT_EQ(checked.exit_code, 0) << checked.out << checked.err;
  EXPECT_EQ(Do("scenario rename box_rests carton_stands").exit_code, 0) << "in its folder";
  EXPECT_TRUE(fs::exists(Scenario("still/carton_stands")));
}

TEST_F(SuiteEdge, AWrongNewNameChangesNothing) {
  Accept();
  const auto refused = [&](const std::string& words, const std::string& why) {
    const Said said = Do("scenario rename " + words);
    EXPECT_NE(said.exit_code, 0) << words;
    EXPECT_NE(said.err.find(why), std::string::npos) << said.err;
    EXPECT_TRUE(fs::exists(Scenario()) && fs::exists(Golden())) << words;
  };
  WriteVariant("rest/other", "wait_s: 0.2", "wait_s: 0.3");
  WriteFile(Golden("rest/third"), ReadFile(Golden()));
  refused("carton_rests other", "is there already");
  refused("carton_rests third", "there is a golden of 'rest/third' already");
  refused("carton_rests Other", "found 'Other', wanted NAME or SKILL/NAME");
  refused("carton_rest other2", "no scenario 'carton_rest'");
  // What lies beside the scenario would not lie beside the new one.
  fs::remove(Golden("rest/third"));
  WriteFile(root_ / "scenarios/rest/own.grammar", "grammar own\nuse pick_and_place\n");
  WriteFile(Scenario(), Replaced(ReadFile(Scenario()), "tags:", "grammar: ./own.grammar\ntags:"));
  refused("carton_rests still/box", "own.grammar");
}

}  // namespace
}  // namespace prehend::house
