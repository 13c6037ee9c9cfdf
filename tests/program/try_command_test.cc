// SPDX-License-Identifier: Apache-2.0
// prehend grammar try, as a person or a script uses it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

constexpr const char* kGrammar =
    "grammar taps\nparam longest = 0.2 s\n"
    "event tap(hand: Hand, object: Thing) while touching(hand, object) lasting 50 ms to longest\n";
constexpr const char* kDrawing =
    "== two touches\nentities hand:Hand drum:Fixed\nhand holds drum |..00......00000...|\n--\n"
    "tap(hand, drum) |..[=..............|\n";

class TryCommand : public ::testing::Test {
 protected:
  std::string File(const std::string& name, const std::string& text) {
    const auto path = folder_ / name;
    WriteFile(path, text);
    return path.string();
  }
  std::filesystem::path folder_ = FreshFolder("try");
};

TEST_F(TryCommand, ADrawingAgreesOrDiffersRowByRow) {
  const std::string grammar = File("taps.grammar", kGrammar);
  const std::string drawing = File("taps.txt", kDrawing);
  const Said agrees = Prehend({"grammar", "try", grammar, drawing});
  EXPECT_EQ(agrees.exit_code, 0) << agrees.err;
  EXPECT_EQ(agrees.out, "agrees   " + drawing + ":1 two touches\n1 of 1 drawings agree\n");
  const Said differs = Prehend({"grammar", "try", grammar, drawing, "--set", "longest=0.3 s"});
  EXPECT_EQ(differs.exit_code, 1) << differs.err;
  EXPECT_EQ(differs.out, "differs  " + drawing +
                             ":1 two touches\n"
                             "  wanted tap(hand, drum)             |..[=..............|\n"
                             "  found  tap(hand, drum)             |..[=......[====...|\n"
                             "0 of 1 drawings agree\n");
  const Said json = Prehend({"grammar", "try", grammar, drawing, "--json"});
  const auto parsed = nlohmann::json::parse(json.out);
  EXPECT_EQ(parsed["grammar"], "taps");
  EXPECT_EQ(parsed["drawings"][0]["agrees"], true);
  EXPECT_EQ(parsed["drawings"][0]["found"][0]["cells"], "..[=..............");
}

TEST_F(TryCommand, ARowWithoutEventsSaysThatThereAreNone) {
  const std::string grammar = File("taps.grammar", kGrammar);
  const std::string head = "entities hand:Hand drum:Fixed\nhand holds drum ";
  const Said none = Prehend(
      {"grammar", "try", grammar, File("none.txt", head + "|....|\n--\ntap(hand, drum) |....|\n")});
  EXPECT_EQ(none.exit_code, 0) << none.out;
  const Said one = Prehend(
      {"grammar", "try", grammar, File("one.txt", head + "|.00.|\n--\ntap(hand, drum) |....|\n")});
  EXPECT_EQ(one.exit_code, 1) << one.out;
  EXPECT_NE(one.out.find("  found  tap(hand, drum)             |.[=.|\n"), std::string::npos)
      << one.out;
}

TEST_F(TryCommand, ADrawingThatExpectsNothingShowsWhatThereIs) {
  const std::string grammar = File("taps.grammar", kGrammar);
  const std::string drawing =
      File("taps.txt", "entities hand:Hand drum:Fixed\nhand holds drum |.00.|\n");
  const Said said = Prehend({"grammar", "try", grammar, drawing});
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_NE(said.out.find("  found  tap(hand, drum)             |.[=.|\n"), std::string::npos)
      << said.out;
  EXPECT_TRUE(said.out.ends_with("\n0 of 0 drawings agree\n")) << "it claims nothing" << said.out;
  const Said json = Prehend({"grammar", "try", grammar, drawing, "--json"});
  EXPECT_EQ(nlohmann::json::parse(json.out)["drawings"][0]["expects_nothing"], true);
}

TEST_F(TryCommand, MistakesHaveTheirPlaceAndExitCodeTwo) {
  const std::string grammar = File("taps.grammar", kGrammar);
  const std::string drawing =
      File("taps.txt", "entities hand:Hand drum:Fixed\nhand holds drom |.00.|\n");
  const Said said = Prehend({"grammar", "try", grammar, drawing});
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_EQ(said.out, "");
  EXPECT_TRUE(said.err.starts_with(drawing + ":2:12: error: nobody is called 'drom'\n"))
      << said.err;
  EXPECT_NE(said.err.find("did you mean 'drum'?"), std::string::npos) << said.err;
  EXPECT_EQ(Prehend({"grammar", "try", grammar, (folder_ / "none.txt").string()}).exit_code, 2);
  EXPECT_EQ(Prehend({"grammar", "try", "no_such", drawing}).exit_code, 2);
}

TEST_F(TryCommand, WhatCannotBeIsAMistakeAndNoDifference) {
  const std::string grammar = File("taps.grammar", kGrammar);
  const std::string head = "entities hand:Hand drum:Fixed\n";
  const Said sets =
      Prehend({"grammar", "try", grammar, File("sets.txt", head + "hand holds drum |.4.|\n")});
  EXPECT_EQ(sets.exit_code, 2);
  EXPECT_NE(sets.err.find(":2:19: error: 'holds' takes 0..3 or '.', found '4'"), std::string::npos)
      << sets.err;
  const Said swapped =
      Prehend({"grammar", "try", grammar,
               File("swapped.txt", head + "hand holds drum |.2.|\n--\ntap(drum, hand) |.[.|\n")});
  EXPECT_EQ(swapped.exit_code, 2);
  EXPECT_NE(swapped.err.find("did you mean 'tap(hand, drum)'?"), std::string::npos) << swapped.err;
}

// What stands between two lines that begin with ```.
std::vector<std::string> Blocks(const std::string& page) {
  std::vector<std::string> blocks;
  std::istringstream lines(page);
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) {
      inside = !inside;
      if (inside) blocks.emplace_back();
    } else if (inside) {
      blocks.back() += line + "\n";
    }
  }
  return blocks;
}

TEST_F(TryCommand, TheCookbookIsRight) {
  const std::vector<std::string> blocks = Blocks(ReadFile(PREHEND_SOURCE_DIR "/docs/cookbook.md"));
  int tried = 0;
  for (std::size_t i = 0; i + 1 < blocks.size(); ++i) {
    if (!blocks[i].starts_with("grammar ")) continue;
    const std::string number = std::to_string(++tried);
    const Said said = Prehend({"grammar", "try", File(number + ".grammar", blocks[i]),
                               File(number + ".txt", blocks[i + 1])});
    EXPECT_EQ(said.exit_code, 0) << said.out << said.err;
    EXPECT_EQ(said.err, "");
  }
  EXPECT_EQ(tried, 15);
}

}  // namespace
}  // namespace prehend::house
