// SPDX-License-Identifier: Apache-2.0
// Pictures against their goldens, without drawing: what is said, and what is stored. Pixels are
// compared in tests/program/golden_workflow_test.cc
#include "harness/show/pictures/pictures.h"
#include "harness/suite/judge/judges.h"
#include "tests/harness/suite/judge/checked_run.h"

namespace prehend::suite {
namespace {

namespace fs = std::filesystem;

using JudgePicturesTest = CheckedScenario;

TEST_F(JudgePicturesTest, OnlyPicturesWithAGoldenAreCompared) {
  const fs::path golden = Write("golden/rest/x.png", "no picture");
  const show::GoldenOf golden_of = GoldensOf("rest/x", root_.string());
  EXPECT_EQ(golden_of("x.png"), golden);
  EXPECT_EQ(golden_of("x-2.png"), "");
  show::WrittenPicture with{"report/x.png", "", ""}, without{"report/x-2.png", "", ""};
  with.golden = golden.string();
  with.difference = {.told = {"the title is missing"}, .same_size = true};
  auto compared = ComparisonsOf("rest/x", {with, without}, root_.string(), true);
  ASSERT_EQ(compared.size(), 1u);
  EXPECT_EQ(compared[0].golden, golden);
  EXPECT_EQ(compared[0].drawn, "report/x.png");
  EXPECT_EQ(compared[0].told, with.difference.told);
  EXPECT_EQ(compared[0].shown_in.filename(), "x.difference.png");
  with.difference.same_size = false;
  compared = ComparisonsOf("rest/x", {with}, root_.string(), true);
  EXPECT_EQ(compared.at(0).shown_in, "") << "there are no pixels to show";
}

TEST_F(JudgePicturesTest, TheTextSaysWhatDiffersAndWhereEverythingIs) {
  const std::vector<PictureComparison> compared = {
      {.golden = "g/same.png", .drawn = "r/same.png", .told = {}, .shown_in = ""},
      {.golden = "g/x.png",
       .drawn = "r/x.png",
       .told = {"the title is missing", "5 % differ"},
       .shown_in = "d.png"},
      {.golden = "g/y.png", .drawn = "r/y.png", .told = {"other size"}, .shown_in = ""}};
  EXPECT_EQ(PictureDifferencesText(compared, "prehend accept x --pictures"),
            "picture r/x.png:\n  the title is missing\n  5 % differ\n  expected g/x.png\n"
            "  difference d.png\n  accept it with: prehend accept x --pictures\n"
            "picture r/y.png:\n  other size\n  expected g/y.png\n"
            "  accept it with: prehend accept x --pictures\n");
  EXPECT_EQ(PictureDifferencesText({compared[2]}, ""),
            "picture r/y.png:\n  other size\n  expected g/y.png\n");
}

TEST_F(JudgePicturesTest, GoldensThatTheScenarioDoesNotAskForAreFindings) {
  const std::string one = Write("golden/rest/x.png", ""), two = Write("golden/rest/x-2.png", "");
  EXPECT_TRUE(JudgeUnrequestedPictures("rest/x", 2, root_.string(), "accept").empty());
  const Findings findings = JudgeUnrequestedPictures("rest/x", 1, root_.string(), "accept");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].exit_code, ExitCode::kDiffers);
  EXPECT_EQ(findings[0].reason, "a golden picture that the scenario does not ask for");
  EXPECT_EQ(findings[0].details,
            two + " belongs to no picture: the scenario asks for 1\n  remove it, or: accept\n");
}

TEST_F(JudgePicturesTest, WhatDiffersIsKeptForReviewUntilItDoesNot) {
  const fs::path drawn = Write("report/x.png", "new"), golden = Write("golden/rest/x.png", "old");
  const fs::path pending = root_ / "build/pending/rest/x.png";
  PictureComparison compared{.golden = golden, .drawn = drawn, .told = {"5 %"}, .shown_in = {}};
  StorePictures("rest/x", {compared}, root_.string());
  EXPECT_TRUE(fs::exists(pending));
  StorePictures("rest/x", {compared}, root_.string());
  EXPECT_TRUE(fs::exists(pending)) << "it takes the place of the one before";
  compared.told.clear();
  StorePictures("rest/x", {compared}, root_.string());
  EXPECT_FALSE(fs::exists(pending));
}

}  // namespace
}  // namespace prehend::suite
