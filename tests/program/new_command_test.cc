// SPDX-License-Identifier: Apache-2.0
// `new NAME` writes a scenario that does what its name says: each verb is played, and its claims
// hold.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;

bool Has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class New : public testing::Test {
 protected:
  New() { WriteFile(folder_ / "prehend.yaml", ""); }
  ~New() override { fs::remove_all(folder_); }

  static Said In(const fs::path& folder, const std::vector<std::string>& words) {
    return Prehend(words, {"CI="}, "unset PREHEND_HOME && cd '" + folder.string() + "'");
  }
  Said Do(const std::vector<std::string>& words) const { return In(folder_, words); }
  std::string TextOf(const std::string& name) const {
    return ReadFile(folder_ / "scenarios/pick_and_place" / (name + ".yaml"));
  }

  const fs::path folder_ =
      FreshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
};

/// A name, and what its file must say.
struct Named {
  std::string name;
  std::vector<std::string> says;
};

TEST_F(New, DoesWhatTheNameSays) {
  const std::vector<Named> all = {
      {"cup_is_lifted", {"cup: {class: Cup, mug: ", "no putting_down", "reach: cup}"}},
      {"carton_is_moved", {"pick_and_place(right_hand, carton)"}},
      {"red_apple_is_carried", {"red_apple: {class: Apple, sphere: ", "a red apple is picked up"}},
      {"can_is_slid", {"one sliding(right_hand, can)"}},
      {"box_is_pushed", {"contact(right_hand, box)", "until: touching(box)"}},
      {"mug_is_pressed", {"presses a box onto the table"}},
      {"cup_is_put_onto_a_tray", {"place_on: tray", "supported_by(cup, tray)"}},
      {"ball_is_put_into_a_bowl", {"place_on: bowl", "supported_by(ball, bowl)"}},
      {"cubes_are_stacked", {"place_on: second_cube"}},
      {"beans_are_poured_from_a_mug", {"pouring(right_hand, mug, bowl)"}},
      {"bottle_is_handed_over", {"grasping(left_hand, bottle)"}},
      {"drawer_is_opened", {"opened_by(drawer, right_hand)"}},
      {"drawer_is_shut", {"closed_by(drawer, right_hand)"}},
      {"door_is_opened", {"opened_by(door, right_hand)"}},
      {"door_is_closed", {"closed_by(door, right_hand)"}},
      {"table_is_wiped_with_a_sponge", {"sponge: {class: Sponge"}},
      {"bottle_is_shaken", {"bottle: {class: Bottle", "repeat: 3"}},
      {"soup_is_stirred", {"stirring(right_hand, spoon, pot)"}},
      {"carton_is_turned", {"turn_by_deg: [0, 0, 90]"}},
      {"can_is_dropped", {"no putting_down"}},
      {"ball_is_thrown", {"relative_to: hand"}},
  };
  for (const Named& named : all) {
    const Said made = Do({"new", named.name});
    ASSERT_EQ(made.exit_code, 0) << named.name << "\n" << made.err;
    for (const std::string& part : named.says)
      EXPECT_TRUE(Has(TextOf(named.name), part)) << named.name << ": " << part;
  }
  const Said checked = Do({"check", "--no-pictures"});
  EXPECT_EQ(checked.exit_code, 5) << "pending, and no claim is wrong\n" << checked.out;
  EXPECT_FALSE(Has(checked.out, "failed  ")) << checked.out;
  EXPECT_FALSE(Has(checked.out, "note: ")) << checked.out;
}

TEST_F(New, SaysWhichWordsItLeavesOut) {
  const std::vector<std::pair<std::string, std::string>> all = {
      {"drawer_is_shut_with_the_left_elbow",
       "note: of the name, 'left', 'elbow' are left out; docs/script-cookbook.md has it: 'With the "
       "elbow'\n"},
      {"box_is_carried_along_a_wall",
       "note: of the name, 'along', 'wall' are left out; docs/script-cookbook.md has it: 'Along a "
       "wall'\n"},
      {"bottle_is_shaken_wildly",
       "note: of the name, 'wildly' is left out; docs/script-cookbook.md has scripts to copy\n"},
      {"blue_bottle_is_shaken_three_times", ""},
      {"table_is_wiped_with_a_sponge", ""},
      {"ball_is_put_into_a_bowl", ""}};
  for (const auto& [name, note] : all) EXPECT_EQ(Do({"new", name}).err, note) << name;
  const Said rests = Do({"new", "hand_rests_beside_a_can"});
  EXPECT_TRUE(
      rests.err.starts_with("note: the name has no verb that 'new' knows, so this is 'carry'"))
      << rests.err;
  EXPECT_TRUE(rests.err.ends_with(
      "; of the name, 'rests', 'beside' are left out; docs/script-cookbook.md has it: 'Rest "
      "beside'\n"))
      << rests.err;
  EXPECT_EQ(Do({"new", "elbow_of_mine", "--like", "pour"}).err.find("left out"), std::string::npos);
}

TEST_F(New, SaysWhatTheNameLeftOpen) {
  const Said no_verb = Do({"new", "first_try"});
  EXPECT_TRUE(Has(no_verb.err,
                  "note: the name has no verb that 'new' knows, so this is 'carry'; "
                  "choose by --like: carry, drop, hand_over, lift, "))
      << no_verb.err;
  EXPECT_EQ(Do({"new", "second_try", "--like", "shake"}).err,
            "note: the name has no thing that 'new' knows, so this is about a bottle; known: "
            "bottle, carton, milk, can, jar, box\n");
  EXPECT_EQ(Do({"new", "ball_is_shaken"}).err,
            "note: 'shake' is written for bottle, carton, milk, can, jar, box only, so this is "
            "about a bottle\n");
  EXPECT_EQ(Do({"new", "cup_is_lifted"}).err, "");
  const Said wrong = Do({"new", "third_try", "--like", "shakes"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_TRUE(wrong.err.starts_with(
      "prehend: --like: no verb is called 'shakes'; did you mean 'shake'? known: carry, drop, "))
      << wrong.err;
  EXPECT_EQ(Do({"new", "Cup_is-Lifted"}).err,
            "prehend: 'Cup_is-Lifted' is not a scenario name; wanted a small letter, then small "
            "letters, digits and '_', at most 64 in all, like cup_is_lifted; a folder may precede "
            "it, like slide/slide_then_transport\n");
  EXPECT_TRUE(Has(Do({"new", "a", "--like", "shake", "--like", "milk_carton_wrap"}).err,
                  "--like is given more than once"));
}

TEST_F(New, AVerbIsAFileInTheFolderOfTemplates) {
  const fs::path file = folder_ / "scenarios/templates/nudge.yaml";
  std::string text = ReadFile(fs::path(PREHEND_SOURCE_DIR) / "scenarios/templates/push.yaml");
  text.replace(text.find("words: [push"), 12, "words: [nudged");
  WriteFile(file, text);
  EXPECT_TRUE(Has(Do({"new", "--help"}).out, " nudge, ")) << "beside those that ship";
  ASSERT_EQ(Do({"new", "cup_is_nudged"}).exit_code, 0);
  EXPECT_TRUE(Has(TextOf("cup_is_nudged"), "an open hand pushes a cup along the table"));
  EXPECT_EQ(Do({"list"}).err, "") << "a template is no scenario";
  EXPECT_FALSE(Has(Do({"list"}).out, "templates"));
  EXPECT_TRUE(Do({"new", "templates/cup_is_slid"})
                  .err.starts_with("prehend: scenarios/templates/ holds templates of 'new', which "
                                   "no command reads as scenarios; choose another folder, like "));

  const auto error_with = [&](const std::string& from, const std::string& to) {
    std::string wrong = text;
    wrong.replace(wrong.find(from), from.size(), to);
    WriteFile(file, wrong);
    const Said said = Do({"new", "can_is_nudged"});
    EXPECT_EQ(said.exit_code, 2);
    EXPECT_FALSE(fs::exists(folder_ / "scenarios/pick_and_place/can_is_nudged.yaml"));
    return said.err.substr(said.err.find("nudge.yaml"));
  };
  EXPECT_TRUE(error_with("words:", "word:")
                  .starts_with("nudge.yaml:2:1: error: unknown key 'word' in a verb\n"));
  EXPECT_TRUE(error_with("no grasping", "no @grasping@")
                  .starts_with("nudge.yaml:10:8: error: no mark is called '@grasping@'"));
  EXPECT_TRUE(error_with("things: [carton", "things: [cartoon")
                  .starts_with("nudge.yaml:4:10: error: no thing is called 'cartoon'"));
  const std::string script = error_with("until: touching(@thing@)", "until: touching(cap)");
  const auto line = std::to_string(
      std::count(text.begin(), text.begin() + static_cast<long>(text.find("until:")), '\n') + 1);
  EXPECT_TRUE(script.starts_with("nudge.yaml:" + line + ":")) << script;
}

TEST_F(New, WritesIntoThePresentFolderOutsideOfAProject) {
  fs::remove(folder_ / "prehend.yaml");
  const fs::path shipped =
      fs::path(PREHEND_SOURCE_DIR) / "scenarios/pick_and_place/jar_of_a_stranger_is_lifted.yaml";
  const Said made = Do({"new", "jar_of_a_stranger_is_lifted"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_FALSE(fs::exists(shipped));
  EXPECT_TRUE(fs::exists(folder_ / "jar_of_a_stranger_is_lifted.yaml"));
  EXPECT_TRUE(Has(made.out,
                  "this folder is in no project, so the file stands alone; a project keeps "
                  "goldens: prehend new --project DIR\n"))
      << made.out;
  EXPECT_TRUE(Has(made.out, "  prehend run jar_of_a_stranger_is_lifted.yaml\n")) << made.out;
  const Said run = Do({"run", "jar_of_a_stranger_is_lifted.yaml"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(Has(run.out, "picking_up")) << run.out;
  const Said again = Do({"new", "jar_of_a_stranger_is_lifted"});
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_TRUE(Has(again.err, "prehend: this file exists: ")) << again.err;
}

}  // namespace
}  // namespace prehend::house
