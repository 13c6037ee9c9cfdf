// SPDX-License-Identifier: Apache-2.0
// Goldens on disk: where they are, what is refused, what is pending.
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "harness/suite/judge/validate_golden.h"
#include "harness/truth/golden/golden.h"

namespace prehend::truth {
namespace {

namespace fs = std::filesystem;

class GoldenFilesTest : public testing::Test {
 protected:
  GoldenFilesTest() { fs::remove_all(root_); }
  ~GoldenFilesTest() override { fs::remove_all(root_); }

  const fs::path root_ =
      fs::path(testing::TempDir()) /
      ("golden_files_" +
       std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
  const GoldenFiles files_{root_};
  const Golden golden_{.scenario = "slide/x", .grammar = "g"};
};

TEST_F(GoldenFilesTest, NoneYetIsNotAnError) {
  const auto result = files_.ReadGoldenOf("slide/x");
  ASSERT_TRUE(result) << grammar::Format(ErrorsOf(result));
  EXPECT_EQ(*result, std::nullopt);
  EXPECT_TRUE(files_.List().empty());
}

TEST_F(GoldenFilesTest, AcceptingRemovesWhatWasPending) {
  EXPECT_EQ(files_.WritePending(golden_), "");
  EXPECT_TRUE(fs::exists(root_ / "build/pending/slide/x.timeline"));
  EXPECT_FALSE(fs::exists(root_ / "golden"));
  EXPECT_EQ(files_.WriteAccepted(golden_), "");
  EXPECT_FALSE(fs::exists(root_ / "build/pending/slide/x.timeline"));
  EXPECT_EQ(files_.ReadGoldenOf("slide/x").value(), golden_);
  EXPECT_EQ(files_.List(), std::vector<std::string>{"slide/x"});
}

TEST_F(GoldenFilesTest, AGoldenOfAnotherScenarioIsRefused) {
  ASSERT_EQ(files_.WriteAccepted(golden_), "");
  fs::copy(root_ / "golden/slide/x.timeline", root_ / "golden/slide/y.timeline");
  const auto result = files_.ReadGoldenOf("slide/y");
  ASSERT_EQ(result.error().size(), 1u);
  EXPECT_EQ(result.error()[0].message, "this golden says it is of 'slide/x', not of 'slide/y'");
}

TEST_F(GoldenFilesTest, PicturesBelongToAScenarioAndAPictureOfIt) {
  for (const char* file : {"golden/slide/x.png", "golden/slide/x-3.png", "golden/slide/x-two.png",
                           "golden/y-12.png", "golden/slide/x_on.png", "build/pending/slide/x.png",
                           "build/pending/slide/x.difference.png"}) {
    ASSERT_EQ(WriteTextFile(root_ / file, "a picture"), "");
  }
  const std::vector<episode::ScenarioFile> all = {{.skill = "slide", .name = "x", .path = {}}};
  ASSERT_EQ(files_.PicturesOf("slide/x").size(), 2u);
  EXPECT_EQ(files_.PicturesOf("slide/x")[1].number, 3);
  EXPECT_EQ(files_.PendingPictures().size(), 1u) << "what differs is no picture of the scenario";
  EXPECT_EQ(suite::UnrequestedPictures("slide/x", 2, root_),
            std::vector<fs::path>{root_ / "golden/slide/x-3.png"});
  const std::vector<suite::UnreferencedGolden> orphans = suite::FindUnreferencedGoldens(all, root_);
  ASSERT_EQ(orphans.size(), 2u);
  EXPECT_EQ(orphans[0].scenario, "slide/x_on");
  EXPECT_EQ(Text(orphans[1]),
            (root_ / "golden/y-12.png").string() +
                " belongs to no scenario: remove it, or bring scenarios/y.yaml back\n");
  files_.RemovePendingPicture("slide/x", "x.png");
  EXPECT_TRUE(fs::is_empty(root_ / "build/pending/slide"));
}

// A golden holds every reason that was ever given, so nothing that is typed may cost it.
TEST_F(GoldenFilesTest, HostileReasonsAndNamesLeaveItReadable) {
  const std::vector<std::string> pieces = {"why",
                                           " ",
                                           "  ",
                                           "#",
                                           "# accepted: 2020-01-01: x",
                                           "accepted",
                                           ":",
                                           ": ",
                                           "2026-01-01",
                                           "# scenario: y",
                                           "scenario: ",
                                           "# ",
                                           "\n",
                                           "\n# scenario: z\n",
                                           "\r",
                                           "\t",
                                           std::string(1, '\0'),
                                           "\x1b[31m",
                                           "\xe9t\xe9",
                                           "\xff",
                                           "\u009b",
                                           "\u202e",
                                           "\u2028",
                                           "\ufffe",
                                           "\\",
                                           "\"",
                                           "'",
                                           "=",
                                           "a=b",
                                           "tolerance=5ms because",
                                           "because",
                                           "@2",
                                           "~",
                                           "0.1 0.2 contact(a, b)",
                                           "%s",
                                           "Milchtüte",
                                           std::string(3000, 'x'),
                                           "---",
                                           "...",
                                           "pictures",
                                           "derived",
                                           "# derived: ",
                                           "ticks_per_second"};
  std::mt19937 random(7);
  const auto hostile = [&] {
    std::string text;
    for (unsigned i = 1 + random() % 4; i > 0; --i) text += pieces[random() % pieces.size()];
    return text;
  };
  const Golden first{.scenario = "slide/x",
                     .grammar = "g",
                     .derived = {"it follows"},
                     .accepted = {{"2026-01-01", "the first reason"}}};
  int written = 0;
  for (int round = 0; round < 200; ++round) {
    ASSERT_EQ(files_.WriteAccepted(first), "");
    Golden next = first;
    next.accepted.push_back({"2026-01-02", round % 4 == 1 ? "plain" : hostile()});
    if (round % 4 == 1) next.derived = {hostile()};
    if (round % 4 == 2) next.grammar = hostile();
    if (round % 4 == 3) next.pictures = {{"2026-01-03", hostile()}};
    const std::string problem = files_.WriteAccepted(next);
    written += problem.empty() ? 1 : 0;
    const auto read = files_.ReadGoldenOf("slide/x");
    ASSERT_TRUE(read && *read) << "round " << round << ": " << Format(ErrorsOf(read));
    EXPECT_EQ(**read, problem.empty() ? next : first) << "round " << round << ": " << problem;
  }
  EXPECT_GT(written, 20);
  EXPECT_LT(written, 180);
}

TEST_F(GoldenFilesTest, WhatCannotBeWrittenIsSaid) {
  ASSERT_EQ(WriteTextFile(root_ / "golden", "a file where a folder should be"), "");
  EXPECT_NE(files_.WriteAccepted(golden_), "");
}

}  // namespace
}  // namespace prehend::truth
