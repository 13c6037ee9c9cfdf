// SPDX-License-Identifier: Apache-2.0
// An episode is judged by the grammar that it was played or recorded with, in every command, unless
// another one is asked for.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScenario = R"(scenario: lift
shows: a bottle is lifted
grammar: [pick_and_place, ./shaking.grammar]
entities:
  table: {class: Table, fixed: true, box: {size_m: [1.2, 0.8, 0.04]}, at_m: [0, 0, 0.74]}
  bottle: {class: Bottle, cylinder: {radius_m: 0.035, length_m: 0.18}, mass_kg: 0.4, on: table, at_m: [0.15, 0]}
actors:
  right_hand: {hand: human_right, at_m: [-0.3, 0, 1.0]}
script:
  - right_hand: {reach: bottle}
  - right_hand: {close_to: 1}
  - right_hand: {lift_by_m: 0.2, over_s: 0.6}
  - right_hand: {wait_s: 0.3}
)";
constexpr const char* kShaking = R"(grammar shaking
use grasp
param up = 15 cm/s
event shaken_up(hand: Hand, object: Movable)
  while grasping(hand, object) and vertical_speed(object) > up
  lasting 80 ms
)";

class OwnGrammar : public testing::Test {
 protected:
  OwnGrammar() {
    WriteFile(folder_ / "lift.yaml", kScenario);
    WriteFile(folder_ / "shaking.grammar", kShaking);
  }
  ~OwnGrammar() override { fs::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  /// What was recognised when it was recorded, as labels.
  std::string LabelsOf(const std::string& episode) const {
    const Said said = Prehend({"episode", "resegment", episode, "-o", Path("labels.csv")});
    EXPECT_EQ(said.exit_code, 0) << said.err;
    return Path("labels.csv");
  }
  void Record(const std::string& scenario, const std::string& file,
              const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {"run", scenario, "--record", file};
    words.insert(words.end(), more.begin(), more.end());
    const Said said = Prehend(words);
    EXPECT_EQ(said.exit_code, 0) << said.err;
  }
  static void ExpectAllRight(const Said& said, const std::string& first_line) {
    EXPECT_EQ(said.exit_code, 0) << said.err;
    EXPECT_TRUE(said.out.starts_with(first_line)) << said.out;
  }
  static double F1At50(std::vector<std::string> words) {
    words.emplace_back("--json");
    const Said said = Prehend(words);
    EXPECT_EQ(said.exit_code, 0) << said.err;
    if (said.exit_code != 0) return -1;
    return nlohmann::json::parse(said.out)["grammars"][0]["total"]["f1_50"].get<double>();
  }
  const fs::path folder_ = FreshFolder("own_grammar");
};

TEST_F(OwnGrammar, ARunRecordedWithAnotherOneIsScoredByIt) {
  const std::string kept = Path("c.episodes");
  Record("milk_carton_wrap", kept, {"--grammar", "original_2020"});
  const std::string labels = LabelsOf(kept);
  ExpectAllRight(Prehend({"score", kept, "--truth", labels}), "original_2020, 1 episode\n");
  EXPECT_EQ(F1At50({"score", kept, "--truth", labels}), 1);
  const std::string over = "reach_radius=20cm..30cm:2";
  for (const std::string& truth : {std::string("recorded"), labels}) {
    const Said swept =
        Prehend({"grammar", "sweep", kept, "--truth", truth, "--over", over, "-o", Path("s.csv")});
    ExpectAllRight(swept, "original_2020: 2 settings on 1 episode; the best F1 is 100.00 %\n");
  }
  const Said margins =
      Prehend({"grammar", "margins", kept, "--truth", "recorded", "--over", "reach_radius"});
  ExpectAllRight(margins, "original_2020, 1 recording\n");
  // Another one is taken where it is asked for.
  const Said other = Prehend({"score", kept, "--truth", labels, "--grammar", "pick_and_place"});
  EXPECT_TRUE(other.out.starts_with("pick_and_place, 1 episode\n")) << other.out << other.err;
}

TEST_F(OwnGrammar, OneOfAProjectStaysWithItsEpisode) {
  const std::string kept = Path("l.episodes");
  Record(Path("lift.yaml"), kept);
  const std::string labels = LabelsOf(kept);
  EXPECT_TRUE(ReadFile(labels).find("shaken_up") != std::string::npos) << ReadFile(labels);
  EXPECT_EQ(F1At50({"score", Path("lift.yaml"), "--truth", labels}), 1);
  fs::remove(folder_ / "shaking.grammar");
  ExpectAllRight(Prehend({"score", kept, "--truth", labels}),
                 "pick_and_place_and_shaking, 1 episode\n");
  EXPECT_EQ(F1At50({"score", kept, "--truth", labels}), 1);
  for (const std::string& truth : {std::string("recorded"), labels}) {
    const Said swept = Prehend({"grammar", "sweep", kept, "--truth", truth, "--over",
                                "up=15cm/s..30cm/s:2", "-o", Path("s.csv")});
    ExpectAllRight(swept,
                   "pick_and_place_and_shaking: 2 settings on 1 episode; the best F1 is "
                   "100.00 %\n");
  }
  const Said margins = Prehend({"grammar", "margins", kept, "--truth", "recorded", "--over", "up"});
  ExpectAllRight(margins, "pick_and_place_and_shaking, 1 recording\n");
}

TEST_F(OwnGrammar, TwoOfOneNameAreNotTakenForOne) {
  Record(Path("lift.yaml"), Path("a.episodes"));
  WriteFile(folder_ / "shaking.grammar", Replaced(kShaking, "80 ms", "90 ms"));
  Record(Path("lift.yaml"), Path("b.episodes"));
  const std::string labels = LabelsOf(Path("a.episodes"));
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"score", "--truth", labels, "--truth", labels},
        {"grammar", "sweep", "--truth", "recorded", "--over", "up=15cm/s..30cm/s:2"},
        {"grammar", "margins", "--truth", "recorded"}}) {
    std::vector<std::string> all = words;
    all.insert(all.end(), {Path("a.episodes"), Path("b.episodes")});
    const Said said = Prehend(all);
    EXPECT_EQ(said.exit_code, 2) << said.out;
    EXPECT_NE(said.err.find("its grammar pick_and_place_and_shaking is not the same as that of"),
              std::string::npos)
        << said.err;
  }
}

}  // namespace
}  // namespace prehend::house
