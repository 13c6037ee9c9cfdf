// SPDX-License-Identifier: Apache-2.0
// A scenario with several grammars, and one beside it.
#include <gtest/gtest.h>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

constexpr const char* kScenario = R"(scenario: shake
shows: a bottle is lifted, shaken twice and set down
expects:
  - one pick_and_place(right_hand, bottle)
  - 3 shaken_up(right_hand, bottle)
grammar: [pick_and_place, furniture, ./shaking.grammar]
entities:
  table: {class: Table, fixed: true, box: {size_m: [1.2, 0.8, 0.04]}, at_m: [0, 0, 0.74]}
  bottle: {class: Bottle, cylinder: {radius_m: 0.035, length_m: 0.18}, mass_kg: 0.4, on: table, at_m: [0.15, 0]}
actors:
  right_hand: {hand: human_right, at_m: [-0.3, 0, 1.0]}
script:
  - right_hand: {reach: bottle}
  - right_hand: {close_to: 1}
  - right_hand: {lift_by_m: 0.2}
  - repeat: 2
    steps:
      - right_hand: {lift_by_m: 0.08, over_s: 0.3}
      - right_hand: {lift_by_m: -0.08, over_s: 0.3}
  - right_hand: {place_on: table}
  - right_hand: {open_to: 0}
  - right_hand: {retreat_by_m: 0.2}
)";
constexpr const char* kShaking = R"(grammar shaking
use grasp
# A hand moves what it holds up, quickly. The first lift counts, too.
event shaken_up(hand: Hand, object: Movable)
  while grasping(hand, object) and vertical_speed(object) > 15 cm/s
  lasting 80 ms
)";

TEST(JoinedGrammars, AllOfThemWatchAScenarioAndItsEpisode) {
  const auto folder = FreshFolder("joined");
  const std::string file = (folder / "shake.yaml").string(),
                    record = (folder / "a.episodes").string();
  WriteFile(file, kScenario);
  WriteFile(folder / "shaking.grammar", kShaking);
  const Said run = Prehend({"run", file, "--record", record});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("shaken_up"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("pick_and_place"), std::string::npos) << run.out;
  EXPECT_EQ(Prehend({"score", file}).exit_code, 0) << "its claims can be judged";
  // The episode keeps all of them, wherever the files are now.
  std::filesystem::remove(folder / "shaking.grammar");
  const Said again = Prehend({"episode", "resegment", record, "--against", "recorded"});
  EXPECT_EQ(again.exit_code, 0) << again.err << again.out;
  const Said line = Prehend({"run", "milk_carton_wrap", "--grammar", "furniture+pick_and_place"});
  EXPECT_EQ(line.exit_code, 0) << line.err;
}

TEST(JoinedGrammars, AreValidated) {
  const auto folder = FreshFolder("joined_validated");
  WriteFile(folder / "shaking.grammar", kShaking);
  const std::string own = (folder / "shaking.grammar").string();
  for (const std::string& joined :
       {std::string("pick_and_place+furniture"), "pick_and_place+" + own, own + "+furniture"}) {
    const Said said = Prehend({"validate", "--grammar", joined});
    EXPECT_EQ(said.exit_code, 0) << said.err;
    EXPECT_TRUE(said.out.starts_with("ok: " + joined + "\n")) << said.out;
  }
  EXPECT_EQ(Prehend({"validate", "pick_and_place+" + own}).exit_code, 0) << "by its place";
  const Said unknown = Prehend({"validate", "--grammar", "pick_and_place+furnitur"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("furnitur"), std::string::npos) << unknown.err;
}

TEST(JoinedGrammars, EachThatIsUnknownIsNamed) {
  const auto folder = FreshFolder("joined_bad");
  const std::string file = (folder / "shake.yaml").string();
  std::string text = kScenario;
  text.replace(text.find("furniture,"), 10, "furnitur, ");
  WriteFile(file, text);
  const Said bad = Prehend({"validate", file});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_NE(bad.err.find("grammar: no grammar is called 'furnitur'"), std::string::npos) << bad.err;
  EXPECT_NE(bad.err.find("did you mean 'furniture'?"), std::string::npos) << bad.err;
  EXPECT_NE(bad.err.find("grammar: there is no file './shaking.grammar'"), std::string::npos);
}

}  // namespace
}  // namespace prehend::house
