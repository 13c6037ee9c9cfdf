// SPDX-License-Identifier: Apache-2.0
// A project of one's own, outside of the checkout: nothing is copied into it.
#include <gtest/gtest.h>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;

bool Has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class OwnProject : public testing::Test {
 protected:
  OwnProject() { made_ = In(folder_, {"new", "--project", "kitchen"}); }
  ~OwnProject() override { fs::remove_all(folder_); }

  /// `prehend` called in that folder.
  static Said In(const fs::path& folder, const std::vector<std::string>& words) {
    return Prehend(words, {"CI="}, "unset PREHEND_HOME && cd '" + folder.string() + "'");
  }
  Said Do(const std::vector<std::string>& words) const { return In(kitchen_, words); }

  const fs::path folder_ =
      FreshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
  const fs::path kitchen_ = folder_ / "kitchen";
  Said made_;
};

TEST_F(OwnProject, IsMadeRunCheckedAndAccepted) {
  ASSERT_EQ(made_.exit_code, 0) << made_.err;
  EXPECT_FALSE(fs::exists(kitchen_ / "grammar")) << "no library is copied";
  const Said run = Do({"run", "carton_is_held_still"});
  EXPECT_TRUE(Has(run.out, "held_still")) << run.err;
  EXPECT_EQ(Do({"check", "--no-pictures"}).exit_code, 5);
  const Said accepted = Do({"accept", "carton_is_held_still", "--reason", "as it says"});
  EXPECT_EQ(accepted.exit_code, 0) << accepted.err;
  EXPECT_TRUE(fs::exists(kitchen_ / "golden/pick_and_place/carton_is_held_still.timeline"));
  const Said checked = In(kitchen_ / "scenarios/pick_and_place", {"check"});
  EXPECT_EQ(checked.exit_code, 0) << checked.out << checked.err;
  EXPECT_TRUE(Has(checked.out, "1 passed, 0 failed\n")) << "only its own: " << checked.out;
  EXPECT_TRUE(fs::exists(kitchen_ / "build/report/index.html"));
  EXPECT_EQ(Do({"validate"}).exit_code, 0);
}

TEST_F(OwnProject, IsNotMadeWhereSomethingIs) {
  const Said again = In(folder_, {"new", "--project", "kitchen"});
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_TRUE(Has(again.err, "found kitchen, which is not empty; wanted a new or an empty folder"))
      << again.err;
  EXPECT_EQ(In(folder_, {"new"}).exit_code, 2);
  EXPECT_EQ(In(folder_, {"new", "cup_is_lifted", "--project", "other"}).exit_code, 2);
  EXPECT_FALSE(fs::exists(folder_ / "other"));
}

TEST_F(OwnProject, ComesFirstAndWhatShipsSecond) {
  const Said shipped = Do({"run", "milk_carton_wrap"});
  EXPECT_EQ(shipped.exit_code, 0) << shipped.err;
  EXPECT_TRUE(Has(shipped.out, "transporting")) << shipped.out;
  EXPECT_EQ(Do({"list", "slide/*"}).exit_code, 4) << "a pattern is about what is in the project";
  EXPECT_EQ(Do({"list", "milk_carton_wrap"}).exit_code, 0);
  WriteFile(kitchen_ / "grammars/pick_and_place.grammar",
            ReadFile(fs::path(PREHEND_SOURCE_DIR) / "grammar/library/pick_and_place.grammar") +
                "\nevent mine(a: Movable, b: Fixed)\n  while touching(a, b)\n");
  const Said own = Do({"run", "milk_carton_wrap"});
  EXPECT_TRUE(Has(own.out, "mine")) << own.out << own.err;
  const Said unknown = Do({"run", "milk_carton_wrap", "--grammar", "pourin"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_TRUE(Has(unknown.err, "did you mean 'pouring'? (looked for in ")) << unknown.err;
  EXPECT_TRUE(Has(unknown.err, (kitchen_ / "grammars").string())) << unknown.err;
}

/// A grammar of the library, with a change.
std::string Changed(const std::string& name, const std::string& from, const std::string& to) {
  return Replaced(ReadFile(fs::path(PREHEND_SOURCE_DIR) / "grammar/library" / (name + ".grammar")),
                  from, to);
}

TEST_F(OwnProject, ItsGrammarComesFirstAlsoWhereAnotherUsesIt) {
  for (const char* grammar : {"pick_and_place", "tabletop", "kitchen", "pick_and_place+gaze"}) {
    const std::vector<std::string> run = {"run", "milk_carton_wrap", "--grammar", grammar};
    EXPECT_TRUE(Has(Do(run).out, "grasping")) << grammar;
    WriteFile(kitchen_ / "grammars/grasp.grammar",
              Changed("grasp", "grip_sides   = 2", "grip_sides   = 4"));
    const Said own = Do(run);
    EXPECT_EQ(own.exit_code, 0) << own.err;
    EXPECT_FALSE(Has(own.out, "grasping")) << grammar << "\n" << own.out;
    fs::remove(kitchen_ / "grammars/grasp.grammar");
  }
  // An episode keeps it, and no other of its file has it.
  WriteFile(kitchen_ / "grammars/grasp.grammar",
            Changed("grasp", "grip_sides   = 2", "grip_sides   = 4"));
  const std::vector<std::string> record = {"run", "milk_carton_wrap", "--record", "own.episodes"};
  ASSERT_EQ(Do(record).exit_code, 0);
  fs::remove(kitchen_ / "grammars/grasp.grammar");
  ASSERT_EQ(Do(record).exit_code, 0);
  WriteFile(kitchen_ / "grammars/pick_and_place.grammar",
            Changed("pick_and_place", "lift_rise   = 3 cm", "lift_rise   = 50 cm"));
  ASSERT_EQ(Do(record).exit_code, 0);
  fs::remove(kitchen_ / "grammars/pick_and_place.grammar");
  ASSERT_EQ(Do(record).exit_code, 0);
  fs::rename(kitchen_ / "own.episodes", folder_ / "own.episodes");
  const Said again = In(folder_, {"episode", "resegment", "own.episodes", "--against", "recorded"});
  EXPECT_EQ(again.exit_code, 0) << again.out << again.err;
  EXPECT_TRUE(Has(again.out, "4 episodes, 0 with differences")) << again.out;
}

TEST_F(OwnProject, WhatComesToBeLookedForFirstIsAChange) {
  ASSERT_EQ(Do({"accept", "carton_is_held_still", "--reason", "as it says"}).exit_code, 0);
  const std::vector<std::string> check = {"check", "--no-pictures", "--changed"};
  ASSERT_EQ(Do(check).exit_code, 0);
  const auto is_unchanged = [&](const Said& said) { return Has(said.out, "1 unchanged"); };
  EXPECT_TRUE(is_unchanged(Do(check))) << Do(check).out;
  const fs::path hands = fs::path(PREHEND_SOURCE_DIR) / "physics/library";
  const std::string pick_and_place = "grammars/pick_and_place.grammar",
                    hand = "hands/human_right.hand.yaml";
  WriteFile(kitchen_ / pick_and_place, Changed("pick_and_place", "grammar pick_and_place\n",
                                               "grammar pick_and_place\n# mine\n"));
  EXPECT_FALSE(is_unchanged(Do(check))) << pick_and_place;
  EXPECT_TRUE(is_unchanged(Do(check))) << pick_and_place;
  WriteFile(kitchen_ / "grammars/grasp.grammar",
            Changed("grasp", "grip_sides   = 2", "grip_sides   = 4"));
  const Said failed = Do(check);
  EXPECT_EQ(failed.exit_code, 1) << "used by it: " << failed.out;
  fs::remove(kitchen_ / "grammars/grasp.grammar");
  EXPECT_EQ(Do(check).exit_code, 0);
  WriteFile(kitchen_ / "hands/human.grasps.yaml", ReadFile(hands / "human.grasps.yaml"));
  EXPECT_TRUE(is_unchanged(Do(check))) << "the hand that ships has its own beside it";
  WriteFile(kitchen_ / hand, ReadFile(hands / "human_right.hand.yaml") + "# mine\n");
  EXPECT_FALSE(is_unchanged(Do(check))) << hand;
  EXPECT_TRUE(is_unchanged(Do(check))) << hand;
}

TEST_F(OwnProject, ItsHandsAreFound) {
  const fs::path library = fs::path(PREHEND_SOURCE_DIR) / "physics/library";
  fs::create_directories(kitchen_ / "hands");
  std::string hand = ReadFile(library / "gripper.hand.yaml");
  hand = Replaced(hand, "hand: gripper", "hand: my_gripper");
  WriteFile(kitchen_ / "hands/my_gripper.hand.yaml", hand);
  const fs::path scenario = kitchen_ / "scenarios/pick_and_place/carton_is_held_still.yaml";
  std::string text = Replaced(ReadFile(scenario), "hand: human_right", "hand: my_gripper");
  text = Replaced(text, "{reach: carton}", "{reach: carton, style: parallel}");
  WriteFile(scenario, text);
  const Said said = Do({"validate", "carton_is_held_still"});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  WriteFile(scenario, Replaced(text, "hand: my_gripper", "hand: my_griper"));
  const Said unknown = Do({"validate", "carton_is_held_still"});
  EXPECT_TRUE(Has(unknown.err, "did you mean 'my_gripper'?")) << unknown.err;
}

TEST_F(OwnProject, ItsEpisodesAreReadElsewhere) {
  ASSERT_EQ(Do({"run", "carton_is_held_still", "--record", "held.episodes"}).exit_code, 0);
  fs::rename(kitchen_ / "held.episodes", folder_ / "held.episodes");
  fs::remove_all(kitchen_);
  const Said said = In(folder_, {"episode", "resegment", "held.episodes", "--against", "recorded"});
  EXPECT_EQ(said.exit_code, 0) << said.out << said.err;
  EXPECT_TRUE(Has(said.out, "1 episode, 0 with differences")) << said.out;
}

TEST_F(OwnProject, WritesKnowledgeWithTheTermsThatShip) {
  ASSERT_EQ(Do({"run", "carton_is_held_still", "--record", "held.episodes"}).exit_code, 0);
  const Said said = Do({"episode", "knowledge", "held.episodes", "-o", "kb"});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_TRUE(fs::exists(kitchen_ / "kb/prehend.ttl"));
  const Said asked = Do({"episode", "ask", "kb", "member(X, [1])"});
  EXPECT_FALSE(Has(asked.err, "prehend.pl")) << asked.err;
}

TEST_F(OwnProject, ItsMarkerAndItsFoldersAreNoPlaceForOutputs) {
  const std::string marker = ReadFile(kitchen_ / "prehend.yaml");
  for (const char* file : {"prehend.yaml", "golden/mine/a.timeline", "scenarios/mine/new.yaml"}) {
    const Said said = Do({"run", "carton_is_held_still", "--record", file});
    EXPECT_EQ(said.exit_code, 2) << file;
    EXPECT_TRUE(Has(said.err, std::string("--record: ") + file)) << said.err;
    EXPECT_TRUE(Has(said.err, "name another file")) << said.err;
  }
  EXPECT_EQ(Do({"check", "--report", "golden/report"}).exit_code, 2);
  EXPECT_EQ(ReadFile(kitchen_ / "prehend.yaml"), marker);
  EXPECT_FALSE(fs::exists(kitchen_ / "golden/mine"));
}

TEST_F(OwnProject, WhoIsInNoProjectHasPicturesBelowTheirFolder) {
  const fs::path nowhere = folder_ / "nowhere";
  fs::create_directories(nowhere);
  const std::vector<std::string> render = {"render", "milk_carton_wrap", "--at", "1"};
  const Said said = In(nowhere, render);
  if (Has(said.err, "PREHEND_RENDER=OFF")) GTEST_SKIP() << said.err;
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_FALSE(fs::is_empty(nowhere / "build/pictures/pick_and_place"));
  EXPECT_EQ(In(kitchen_ / "scenarios", render).exit_code, 0);
  EXPECT_FALSE(fs::is_empty(kitchen_ / "build/pictures/pick_and_place"));
  EXPECT_FALSE(fs::exists(kitchen_ / "scenarios/build"));
}

TEST_F(OwnProject, WhatIsOfNoProjectIsNotToBeAccepted) {
  const fs::path nowhere = folder_ / "nowhere";
  fs::create_directories(nowhere);
  ASSERT_EQ(In(nowhere, {"new", "cup_is_lifted"}).exit_code, 0);
  const Said said = In(nowhere, {"check", "cup_is_lifted.yaml", "--no-pictures"});
  EXPECT_EQ(said.exit_code, 5) << said.out << said.err;
  EXPECT_FALSE(Has(said.out, "then accept it")) << said.out;
  EXPECT_TRUE(fs::exists(nowhere / "build/report/some/index.html")) << said.out;
  const Said shipped = Do({"check", "milk_carton_wrap", "--no-pictures"});
  EXPECT_FALSE(Has(shipped.out, "then accept it")) << shipped.out;
}

}  // namespace
}  // namespace prehend::house
