// SPDX-License-Identifier: Apache-2.0
// Scores as a person meets them: every grammar on the same truth, and nothing left out in silence.
#include <nlohmann/json.hpp>

#include "tests/program/small_project.h"

namespace prehend::house {
namespace {

using Json = nlohmann::json;

constexpr const char* kMisspelt = R"(grammar misspelt
use contact
event suported_by(object: Movable, support: Thing) while supported_by(object, support)
)";
constexpr const char* kSilent = R"(grammar silent
event touching_it(object: Movable, support: Thing) while touching(object, support)
)";
constexpr const char* kOwnClosing = R"(grammar own_closing
event closing(hand: Hand) while trigger(hand) < 0.5
)";
constexpr const char* kDrawerSprings = R"(scenario: drawer_springs
shows: a spring opens a drawer while a hand is far away
entities:
  cabinet: {fixed: true, box: {size_m: [0.4, 0.4, 0.4]}, at_m: [0, 0, 0.5]}
  drawer:
    box: {size_m: [0.02, 0.3, 0.1]}
    mass_kg: 1
    at_m: [-0.25, 0, 0.5]
    slider:
      {to: cabinet, axis: [-1, 0, 0], range_m: [0, 0.3], spring_n_per_m: 20, rest_m: 0.15,
       damping_n_s_per_m: 8}
actors:
  right_hand: {hand: human_right, at_m: [-1, -1, 1]}
script:
  - right_hand: {wait_s: 2}
)";

class ScoreCommand : public SmallProject {
 protected:
  ScoreCommand() {
    WriteFile(root_ / "misspelt.grammar", kMisspelt);
    WriteFile(root_ / "silent.grammar", kSilent);
  }
  std::string GrammarOption(const std::string& name) const {
    return " --grammar " + (root_ / (name + ".grammar")).string();
  }
};

TEST_F(ScoreCommand, EveryGrammarIsScoredOnTheSameTruth) {
  const Said said = Do("score --json --grammar contact" + GrammarOption("silent"));
  ASSERT_EQ(said.exit_code, 0) << said.err;
  const Json grammars = Json::parse(said.out)["grammars"];
  EXPECT_EQ(grammars[0]["total"]["true"], 2) << "a contact and a support";
  EXPECT_EQ(grammars[0]["total"]["f1_50"], 1.0);
  EXPECT_EQ(grammars[0]["total"]["further"]["psds"], 1.0);
  EXPECT_EQ(grammars[1]["total"]["true"], 2) << "also when the grammar speaks of neither";
  EXPECT_EQ(grammars[1]["total"]["ward"]["deleted"], 2);
  EXPECT_EQ(grammars[1]["total"]["f1_50"], 0.0);
  EXPECT_EQ(grammars[1]["not_covered"][0], "contact");
  EXPECT_EQ(grammars[1]["ignored"]["touching_it"], 1);
}

TEST_F(ScoreCommand, VerboseRowsHaveWhatWasCompared) {
  const Json row =
      Json::parse(Do("score --json --verbose --grammar contact").out)["grammars"][0]["rows"][0];
  EXPECT_EQ(row["truth_events"]["events"].size(), 2u);
  EXPECT_EQ(row["found_events"]["events"].size(), 2u);
  EXPECT_GT(row["end_tick"], 0);
  const Json& event = row["truth_events"]["events"][0];
  EXPECT_LE(event["begin_band_tick"][0], event["begin_tick"]);
  EXPECT_GE(event["end_band_tick"][1], event["end_tick"]);
  const Json plain = Json::parse(Do("score --json --grammar contact").out);
  EXPECT_FALSE(plain["grammars"][0]["rows"][0].contains("truth_events"));
}

TEST_F(ScoreCommand, WhatIsMisspeltIsListedByName) {
  const Said said = Do("score" + GrammarOption("misspelt"));
  ASSERT_EQ(said.exit_code, 0) << said.err;
  EXPECT_NE(
      said.out.find("\nignored: suported_by (1 found); docs/events.md does not define them\n"),
      std::string::npos)
      << said.out;
  const Said other = Do("score" + GrammarOption("silent"));
  EXPECT_NE(
      other.out.find("\nnot covered: contact (1 true), supported_by (1 true), grasping (0 true), "),
      std::string::npos)
      << other.out;
  EXPECT_NE(other.out.find("; no rule of the grammar prints them, so they count as missed\n"),
            std::string::npos);
}

TEST_F(ScoreCommand, EventsCanBeChosen) {
  const Said said = Do("score --json --event supported_by" + GrammarOption("silent"));
  ASSERT_EQ(said.exit_code, 0) << said.err;
  const Json score = Json::parse(said.out)["grammars"][0];
  EXPECT_EQ(score["total"]["true"], 1);
  EXPECT_EQ(score["not_covered"], Json::array({"supported_by"}));
  const Said wrong = Do("score --event contact,suported_by");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_EQ(wrong.out, "");
  EXPECT_NE(wrong.err.find("defines no 'suported_by'; did you mean 'supported_by'?"),
            std::string::npos)
      << wrong.err;
}

TEST_F(ScoreCommand, FurnitureCountsIfAGrammarHasIt) {
  WriteFile(Scenario("drawer_springs"), kDrawerSprings);
  WriteFile(root_ / "own_closing.grammar", kOwnClosing);
  const auto scores = [&](const std::string& options) {
    const Said said = Do("score drawer_springs --json" + options);
    EXPECT_EQ(said.exit_code, 0) << said.err;
    return Json::parse(said.out)["grammars"];
  };
  EXPECT_EQ(scores(" --grammar contact")[0]["total"]["true"], 0) << "it speaks of no furniture";
  const Json furniture = scores(" --grammar furniture")[0];
  EXPECT_EQ(furniture["total"]["true"], 4)
      << "closed, half closed, half open, opening; " << furniture.dump(1);
  EXPECT_EQ(furniture["total"]["f1_50"], 1.0);
  const Json both = scores(" --grammar contact --grammar furniture")[0];
  EXPECT_EQ(both["total"]["true"], 4) << "all are scored on the same truth";
  EXPECT_EQ(both["total"]["ward"]["deleted"], 4);
  const Json chosen = scores(" --event opening --grammar contact")[0];
  EXPECT_EQ(chosen["not_covered"], Json::array({"opening"}));
  const Json own = scores(GrammarOption("own_closing"))[0];
  EXPECT_EQ(own["ignored"]["closing"], 1) << "an event of a hand is none of furniture";
}

TEST_F(ScoreCommand, EveryCommaHasNamesBesideIt) {
  for (const char* events : {"reaching,,", ",reaching", "reaching,,grasping"}) {
    const Said wrong = Do(std::string("score --event ") + events);
    EXPECT_EQ(wrong.exit_code, 2) << events;
    EXPECT_NE(wrong.err.find("--event: a name is missing next to a comma; write NAME,NAME"),
              std::string::npos)
        << wrong.err;
  }
}

TEST_F(ScoreCommand, WhatCannotBeReadIsBadInputAndNoTable) {
  const std::string path = (root_ / "broken.yaml").string();
  WriteFile(path, "scenario: broken\nentities: [\n");
  const Said said = Do("score " + path);
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_EQ(said.out, "");
  EXPECT_NE(said.err.find("was not scored"), std::string::npos) << said.err;
}

}  // namespace
}  // namespace prehend::house
