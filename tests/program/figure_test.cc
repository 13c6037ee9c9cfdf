// SPDX-License-Identifier: Apache-2.0
// The figures of docs/figures.md, as a person asks for them.
#include <gtest/gtest.h>

#include <sstream>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;

class Figure : public testing::Test {
 protected:
  ~Figure() override { fs::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  Said Do(std::vector<std::string> words) const {
    words.insert(words.begin(), "figure");
    return Prehend(words);
  }

  const fs::path folder_ =
      FreshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
};

bool Has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(Figure, ChartsAreVectorsOrPixels) {
  for (const char* name : {"a.svg", "a.pdf", "a.png"}) {
    const Said said = Do({"phases", "-o", Path(name)});
    ASSERT_EQ(said.exit_code, 0) << said.err;
    EXPECT_EQ(said.out, Path(name) + "\n");
  }
  EXPECT_TRUE(Has(ReadFile(Path("a.svg")), "milk_carton_wrap, pick_and_place"));
  EXPECT_EQ(ReadFile(Path("a.pdf")).substr(0, 4), "%PDF");
  EXPECT_EQ(ReadFile(Path("a.png")).substr(1, 3), "PNG");
  ASSERT_EQ(Do({"plate", "-o", Path("b.svg"), "--from", "1", "--to", "2", "--look", "transparent"})
                .exit_code,
            0);
  EXPECT_FALSE(Has(ReadFile(Path("b.svg")), "\"100%\""));
}

TEST_F(Figure, AnEpisodeIsDrawnAsItsScenario) {
  const std::string episodes = Path("a.episodes");
  ASSERT_EQ(Prehend({"run", "milk_carton_wrap", "--record", episodes}).exit_code, 0);
  ASSERT_EQ(Do({"phases", episodes, "-o", Path("read.svg")}).exit_code, 0);
  ASSERT_EQ(Do({"phases", "-o", Path("played.svg")}).exit_code, 0);
  EXPECT_EQ(ReadFile(Path("read.svg")), ReadFile(Path("played.svg")));
}

TEST_F(Figure, GrammarsAndGoldensAreSideBySide) {
  ASSERT_EQ(Do({"phases", "--against", "original_2020", "-o", Path("a.svg")}).exit_code, 0);
  EXPECT_TRUE(Has(ReadFile(Path("a.svg")), "right_hand (original_2020)"));
  ASSERT_EQ(Do({"phases", "--against", "golden", "-o", Path("b.svg")}).exit_code, 0);
  EXPECT_TRUE(Has(ReadFile(Path("b.svg")), "right_hand (golden)"));
}

TEST_F(Figure, WhatCannotBeDrawnIsRefused) {
  const auto refused = [&](std::vector<std::string> words, const char* why) {
    const Said said = Do(std::move(words));
    EXPECT_EQ(said.exit_code, 2) << said.out;
    EXPECT_TRUE(Has(said.err, why)) << said.err;
  };
  refused({"plates", "-o", Path("a.svg")}, "found 'plates', wanted keyframes, phases, grasps");
  refused({"grasps", "-o", Path("a.gif")}, "wanted a file NAME.svg, NAME.png or NAME.pdf");
  refused({"grasps", "-o", Path("a.png"), "--scenes", "2"}, "--scenes is for charts");
  refused({"phases", "-o", Path("a.png"), "--scenes", "2", "--at", "1"}, "exclude each other");
  refused({"phases", "-o", Path("a.png"), "--at", "nothing.begin"}, "--at: ");
  refused({"phases", "-o", Path("a.png"), "--of", "cup"}, "--of: found 'cup', wanted one of ");
  refused({"phases", "-o", Path("a.gif")}, "a.gif");
  refused({"plate", "-o", Path("a.svg"), "--from", "3", "--to", "2"}, "wanted less than --to");
  for (const char* kind : {"phases", "keyframes", "plate", "gaze"})
    refused({kind, "-o", Path("a.png"), "--from", "1000"}, "found 1000 s, wanted less than the");
  refused({"plate", "-o", Path("a.svg"), "--against", "golden"}, "--against is for phases");
  refused({"phases", "-o", Path("a.svg"), "--against", "nope"}, "no such file");
  const Said alone = Do({"gaze", "milk_carton_wrap", "-o", Path("a.svg")});
  EXPECT_EQ(alone.exit_code, 4);
  EXPECT_TRUE(fs::is_empty(folder_)) << "nothing was written";
}

TEST_F(Figure, ScenesAreSheets) {
  const Said said = Do({"keyframes", "--to", "1.5", "-o", Path("a.png")});
  if (Has(said.err, "PREHEND_RENDER=OFF")) GTEST_SKIP() << said.err;
  ASSERT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(ReadFile(Path("a.png")).substr(1, 3), "PNG");
  ASSERT_EQ(Do({"grasps", "styles/pinch*", "-o", Path("b.png")}).exit_code, 0);
  EXPECT_EQ(Do({"keyframes", "--camera", "nowhere", "-o", Path("c.png")}).exit_code, 2);
}

int Count(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

TEST_F(Figure, TheCasesOfThePaperAreOnOneSheet) {
  const Said said = Do({"keyframes", "--sheet", "paper", "--width", "180mm", "-o", Path("a.svg")});
  if (Has(said.err, "PREHEND_RENDER=OFF")) GTEST_SKIP() << said.err;
  ASSERT_EQ(said.exit_code, 0) << said.err;
  const std::string svg = ReadFile(Path("a.svg"));
  EXPECT_EQ(Count(svg, "data:image/png;base64,"), 10);
  EXPECT_TRUE(Has(svg, ">(a) reaching: a") && Has(svg, ">(j) putting down"));
  EXPECT_EQ(Do({"phases", "--sheet", "paper", "-o", Path("b.svg")}).exit_code, 2);
  EXPECT_EQ(
      Do({"keyframes", "milk_carton_wrap", "--sheet", "paper", "-o", Path("b.svg")}).exit_code, 2);
}

TEST_F(Figure, ThePlateIsCarriedByOneHandAndByTwo) {
  const Said said = Do({"plate", "--scenes", "0", "-o", Path("a.svg")});
  ASSERT_EQ(said.exit_code, 0) << said.err;
  const std::string svg = ReadFile(Path("a.svg"));
  EXPECT_LT(svg.find(">plate_of_a_kilogram_twists_out_of_one_hand,"),
            svg.find(">two_hands_carry_a_plate_of_a_kilogram,"));
  EXPECT_EQ(Count(svg, ">tilt, degrees<"), 1) << "two hands keep it level";
}

TEST_F(Figure, ScenesAreAboveAChart) {
  const Said said = Do({"phases", "-o", Path("a.svg")});
  ASSERT_EQ(said.exit_code, 0) << said.err;
  if (Has(said.err, "draws no scenes")) GTEST_SKIP() << said.err;
  const std::string svg = ReadFile(Path("a.svg"));
  EXPECT_EQ(Count(svg, "data:image/png;base64,"), 5);
  EXPECT_TRUE(Has(svg, ">(a) reaching begins<"));
  ASSERT_EQ(Do({"phases", "--at", "grasping.begin,2", "-o", Path("b.svg")}).exit_code, 0);
  EXPECT_EQ(Count(ReadFile(Path("b.svg")), "data:image/png;base64,"), 2);
  ASSERT_EQ(Do({"phases", "--scenes", "0", "-o", Path("c.svg")}).exit_code, 0);
  EXPECT_EQ(Count(ReadFile(Path("c.svg")), "data:image/png;base64,"), 0);
  ASSERT_EQ(Do({"gaze", "-o", Path("d.svg")}).exit_code, 0);
  EXPECT_TRUE(Has(ReadFile(Path("d.svg")), ">(a) anna sees milk for "));
}

/// The commands of the page's blocks of shell.
std::vector<std::string> DocumentedCommands() {
  std::vector<std::string> commands;
  std::istringstream page(ReadFile(PREHEND_SOURCE_DIR "/docs/figures.md"));
  bool in_shell = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("```")) in_shell = line == "```sh";
    if (in_shell && line.starts_with("prehend ")) commands.push_back(line.substr(8));
  }
  return commands;
}

TEST_F(Figure, TheCommandsOfThePageRun) {
  const std::vector<std::string> commands = DocumentedCommands();
  EXPECT_EQ(commands.size(), 16u);
  for (const std::string& command : commands) {
    // Words as a shell splits them; what is written goes to this test's folder.
    std::vector<std::string> words;
    std::istringstream text(command);
    std::string file;
    for (std::string word; text >> word;) {
      std::erase(word, '\'');
      const bool is_file = !words.empty() && (words.back() == "-o" || words.back() == "--film");
      if (is_file) file = word = Path(word);
      words.push_back(word);
    }
    const Said said = Prehend(words);
    if (Has(said.err, "is not installed") || Has(said.err, "PREHEND_RENDER=OFF")) continue;
    EXPECT_EQ(said.exit_code, 0) << command << "\n" << said.err;
    EXPECT_EQ(said.err, "") << command;
    EXPECT_TRUE(fs::exists(file)) << command;
    fs::remove_all(file);  // two commands write a file of this name
  }
}

}  // namespace
}  // namespace prehend::house
