// SPDX-License-Identifier: Apache-2.0
// Bad input ends with exit code 2 and a clear message on stderr, prints nothing on stdout and
// writes nothing.
// ./test runs this suite a second time against the program built with sanitizers.
#include <gtest/gtest.h>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

const char* const kScenario = R"(scenario: probe
shows: a carton on a table
grammar: pick_and_place
world: {engine: bullet, rate_hz: 480, sensing_hz: 240, seed: 1}
entities:
  table: {class: Table, fixed: true, box: {size_m: [1.2, 0.8, 0.04]}, at_m: [0, 0, 0.74]}
  milk: {class: MilkCarton, box: {size_m: [0.07, 0.07, 0.20]}, mass_kg: 0.4, friction: 0.8, on: table, at_m: [0.2, 0.1]}
actors:
  right_hand: {hand: human_right, at_m: [-0.2, -0.2, 1.05]}
script:
  - right_hand: {reach: milk, style: wrap, over_s: 0.8}
)";

struct Case {
  std::string name;
  std::string text;
  std::string complaint;  ///< part of the first line of stderr
};

std::vector<Case> Cases() {
  const auto edited = [](const char* from, const char* to) {
    return Replaced(kScenario, from, to);
  };
  std::string binary =
      "\x7f"
      "ELF\x02\x01\x01";
  binary.append(64, '\0');
  return {
      {"empty", "", "empty"},
      {"only_a_comment", "# nothing\n", "probe.yaml: error: the file contains only comments\n"},
      {"binary", binary, "probe.yaml:1:"},
      {"not_utf8", "scenario: \xff\xfe\n", "probe.yaml:1:11: error"},
      {"brackets", std::string(10'000, '['), "probe.yaml:1:"},
      {"braces", std::string(10'000, '{'), "probe.yaml:1:"},
      {"list_not_mapping", "- a\n- b\n", "probe.yaml:1:1: error"},
      {"unclosed", "scenario: [1, 2\n", "probe.yaml:"},
      {"unknown_key", edited("shows:", "show:"), "probe.yaml:2:1: error: unknown key 'show'"},
      {"unknown_key_deep", edited("mass_kg:", "mass:"), "probe.yaml:7:"},
      {"duplicate_key", std::string(kScenario) + "shows: again\n",
       "probe.yaml:12:1: error: duplicate key 'shows'"},
      {"mass_no", edited("mass_kg: 0.4", "mass_kg: no"), "probe.yaml:7:73: error"},
      {"mass_negative", edited("mass_kg: 0.4", "mass_kg: -0.4"), "probe.yaml:7:73: error"},
      {"mass_text", edited("mass_kg: 0.4", "mass_kg: heavy"), "probe.yaml:7:73: error"},
      {"mass_nan", edited("mass_kg: 0.4", "mass_kg: .nan"), "probe.yaml:7:73: error"},
      {"mass_sexagesimal", edited("mass_kg: 0.4", "mass_kg: 1:30"), "probe.yaml:7:73: error"},
      {"unknown_support", edited("on: table", "on: tabel"), "probe.yaml:7:"},
      {"beside_its_support", edited("at_m: [0.2, 0.1]", "at_m: [2.2, 0.1]"), "probe.yaml:7:"},
      {"inside_the_table", edited("on: table, at_m: [0.2, 0.1]", "at_m: [0.2, 0.1, 0.8]"),
       "probe.yaml:7:"},
      {"unknown_actor", edited("- right_hand:", "- left_hand:"), "probe.yaml:11:"},
      {"unknown_object", edited("reach: milk", "reach: mlik"), "probe.yaml:11:"},
      {"unknown_grammar", edited("grammar: pick_and_place", "grammar: pick_and_plaice"),
       "probe.yaml:3:10: error"},
      {"unknown_hand", edited("hand: human_right", "hand: human_write"), "probe.yaml:9:"},
      {"unended_quote", edited("a carton on a table", "'a carton").substr(0, 33),
       "probe.yaml:2:8: error: this quote is not closed\n"},
      {"place_without_reach", edited("reach: milk, style: wrap", "place_on: table"),
       "probe.yaml:11:17: error: place_on: right_hand cannot hold anything here"},
      {"carry_without_reach", edited("reach: milk, style: wrap", "carry_to_m: [0, 0]"),
       "probe.yaml:11:17: error: carry_to_m"},
      {"place_on_itself", std::string(kScenario) + "  - right_hand: {place_on: milk}\n",
       "probe.yaml:12:28: error: place_on: right_hand holds 'milk' and cannot place it on itself"},
      {"picture_of_no_event", std::string(kScenario) + "pictures: [{at: reching.begin}]\n",
       "probe.yaml:12:17: error: at: grammar 'pick_and_place' has no event 'reching'"},
      {"picture_before_the_begin", std::string(kScenario) + "pictures: [{at: -1}]\n",
       "probe.yaml:12:17: error: at: expected a number from 0"},
      {"slow_world", edited("rate_hz: 480, sensing_hz: 240, seed: 1", "rate_hz: 120"),
       "probe.yaml:4:34: error: rate_hz 120 is below sensing_hz, which is 240 unless given"},
      {"zero_gain",
       edited("at_m: [-0.2, -0.2, 1.05]",
              "at_m: [-0.2, -0.2, 1.05], gains: {translation: {proportional_n_per_m: 0}}"),
       "probe.yaml:9:"},
      {"huge_gain",
       edited("at_m: [-0.2, -0.2, 1.05]",
              "at_m: [-0.2, -0.2, 1.05], gains: {translation: {proportional_n_per_m: 1000000}}"),
       "probe.yaml:9:"},
      {"alias", edited("shows: a carton on a table", "shows: *anchor"), "probe.yaml:2:8: error"},
  };
}

class BadInput : public testing::TestWithParam<Case> {};

TEST_P(BadInput, IsRefusedWithExitCodeTwo) {
  const auto folder = FreshFolder("bad-input");
  const auto file = folder / "probe.yaml";
  WriteFile(file, GetParam().text);
  for (const char* command : {"validate", "run"}) {
    const Said said = Prehend({command, file.string()});
    EXPECT_EQ(said.exit_code, 2) << said.err;
    EXPECT_EQ(said.out, "") << command;
    EXPECT_NE(said.err.find(GetParam().complaint), std::string::npos) << said.err;
    EXPECT_LT(said.err.size(), 10'000u) << "a message for people";
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1)
      << "something was written";
  std::filesystem::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(Scenario, BadInput, testing::ValuesIn(Cases()),
                         [](const auto& i) { return i.param.name; });

TEST(BadFile, TheProbeItselfIsGood) {
  const auto folder = FreshFolder("bad-input");
  WriteFile(folder / "probe.yaml", kScenario);
  const Said said = Prehend({"validate", (folder / "probe.yaml").string()});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  std::filesystem::remove_all(folder);
}

TEST(BadFile, FiftyMegabytesAreRefusedUnread) {
  const auto folder = FreshFolder("bad-input-big");
  WriteFile(folder / "big.yaml", "scenario: big\nshows: " + std::string(50 << 20, 'x') + "\n");
  const Said said = Prehend({"run", (folder / "big.yaml").string()});
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_NE(said.err.find("big.yaml"), std::string::npos) << said.err;
  EXPECT_LT(said.err.size(), 2'000u);
  std::filesystem::remove_all(folder);
}

TEST(BadFile, DirectoryAndMissingFile) {
  const auto folder = FreshFolder("bad-input-folder");
  for (const std::string& path : {folder.string(), (folder / "missing.yaml").string()}) {
    const Said said = Prehend({"run", path});
    EXPECT_EQ(said.exit_code, 2) << said.err;
    EXPECT_NE(said.err.find(path), std::string::npos) << said.err;
    EXPECT_EQ(said.out, "");
  }
  std::filesystem::remove_all(folder);
}

TEST(BadFile, GrammarTypoHasACaret) {
  const auto folder = FreshFolder("bad-grammar");
  const std::string text = ReadFile(PREHEND_SOURCE_DIR "/grammar/library/pick_and_place.grammar");
  ASSERT_FALSE(text.empty());
  const std::size_t event = text.find("event ");
  ASSERT_NE(event, std::string::npos);
  const auto file = folder / "typo.grammar";
  WriteFile(file, std::string(text).replace(event, 5, "evnet"));
  const auto scenario = folder / "probe.yaml";
  WriteFile(scenario, kScenario);
  const Said said = Prehend({"run", scenario.string(), "--grammar", file.string()});
  EXPECT_EQ(said.exit_code, 2) << said.err;
  EXPECT_NE(said.err.find("typo.grammar:"), std::string::npos) << said.err;
  EXPECT_NE(said.err.find("error:"), std::string::npos) << said.err;
  EXPECT_NE(said.err.find("\n"), std::string::npos);
  EXPECT_NE(said.err.find("^"), std::string::npos) << said.err;
  EXPECT_EQ(said.out, "");
  std::filesystem::remove_all(folder);
}

TEST(BadFile, GrammarFilesOfEveryUglyKind) {
  const auto folder = FreshFolder("bad-grammar");
  WriteFile(folder / "probe.yaml", kScenario);
  const std::string deep =
      "grammar g\nevent e(a: Entity)\n  while " + std::string(10'000, '(') + "\n";
  for (const std::string& text :
       {std::string(), std::string("\0\1\2", 3), std::string("\xff\xfe"), deep,
        std::string(2 << 20, 'x'), std::string("grammar g\nuse g\n")}) {
    WriteFile(folder / "ugly.grammar", text);
    const Said said = Prehend(
        {"run", (folder / "probe.yaml").string(), "--grammar", (folder / "ugly.grammar").string()});
    EXPECT_EQ(said.exit_code, 2) << said.err.substr(0, 500);
    EXPECT_NE(said.err.find("ugly.grammar"), std::string::npos) << said.err.substr(0, 500);
    EXPECT_EQ(said.out, "");
  }
  std::filesystem::remove_all(folder);
}

TEST(BadFile, UnknownCommandAndOption) {
  EXPECT_EQ(Prehend({"runn"}).exit_code, 2);
  EXPECT_EQ(Prehend({"run", "--jsno"}).exit_code, 2);
  EXPECT_EQ(Prehend({"run"}).exit_code, 2);
}

}  // namespace
}  // namespace prehend::house
