// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "grammar/compile/compile.h"
#include "harness/show/pictures/pictures.h"
#include "harness/suite/check/check_scenario.h"
#include "harness/truth/golden/compare.h"

namespace prehend::suite {
namespace {

namespace fs = std::filesystem;

/// A hand that moves past a cup for a second.
class DrawDifferencesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!show::CanDrawPictures()) GTEST_SKIP() << "this build draws no pictures";
    scenario_.name = "passes";
    scenario_.skill = "reach";
    scenario_.scene.bodies.push_back(
        {.name = "cup", .shapes = {{physics::Box{}, {}}}, .mass_kg = 0.2});
    scenario_.body_classes = {"Cup"};
    scenario_.scene.hands.push_back({.name = "left", .model = {}, .X_WH = {}});
    scenario_.scene.hands[0].model.palm_size_m = {0.1, 0.08, 0.03};
    const auto compiled = grammar::Compile({"g",
                                            "grammar g\nevent near(h: Hand, x: Thing) while "
                                            "touching(x, h) drawn as phase \"#FF0000\"\n"},
                                           nullptr);
    ASSERT_TRUE(compiled.program);
    run_.drawings = truth::EventDrawings(*compiled.program);
    run_.ticks = 480;
    for (grammar::Tick tick = 0; tick <= 480; ++tick) {
      physics::Snapshot& snapshot = run_.recording.emplace_back();
      snapshot.tick = tick;
      snapshot.bodies.resize(1);
      snapshot.hands.resize(1);
      snapshot.hands[0].palm.X_WB.p_m = {0.2, static_cast<double>(tick) / 960, 0.1};
    }
    folder_ = fs::path(PREHEND_BINARY_DIR) / "draw_differences_test";
    fs::remove_all(folder_);
  }
  static grammar::NamedEvent Near(grammar::Tick begin, grammar::Tick end) {
    return {.event = "near", .roles = {{"h", "left"}, {"x", "cup"}}, .interval = {begin, end}};
  }
  std::vector<DrawnDifference> Draw(truth::Pairing pairing) const {
    truth::Comparison comparison;
    comparison.pairings.push_back(std::move(pairing));
    return DrawDifferences(scenario_, run_, comparison, folder_.string());
  }
  std::string Bytes(const ReportedPicture& picture) const {
    std::ifstream file(folder_ / picture.file, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  scenario::Scenario scenario_;
  episode::RunResult run_;
  fs::path folder_;
};

TEST_F(DrawDifferencesTest, ABoundaryIsShownAtBothTimes) {
  const auto moments = Draw({.agreement = truth::LineVerdict::kShifted,
                             .expected = Near(96, 240),
                             .actual = Near(192, 240),
                             .begin_offset = 96,
                             .tolerance = 4});
  ASSERT_EQ(moments.size(), 1u);
  EXPECT_EQ(moments[0].what, "begin of near(left, cup)");
  EXPECT_EQ(moments[0].expected.caption, "golden: 0.2000 s");
  EXPECT_EQ(moments[0].recognised.caption, "recognised: 0.4000 s");
  EXPECT_TRUE(moments[0].in_golden && moments[0].in_run);
}

TEST_F(DrawDifferencesTest, BothBoundariesOfAnEventMayDiffer) {
  const auto moments = Draw({.agreement = truth::LineVerdict::kShifted,
                             .expected = Near(96, 240),
                             .actual = Near(192, 144),
                             .begin_offset = 96,
                             .end_offset = -96,
                             .tolerance = 4});
  ASSERT_EQ(moments.size(), 2u);
  EXPECT_EQ(moments[0].what, "begin of near(left, cup)");
  EXPECT_EQ(moments[1].what, "end of near(left, cup)");
  EXPECT_EQ(moments[1].expected.caption, "golden: 0.5000 s");
  EXPECT_EQ(moments[1].recognised.caption, "recognised: 0.3000 s");
}

TEST_F(DrawDifferencesTest, AnEventThatOnlyOneSideHasIsShownWhereItBegins) {
  const auto missing = Draw({.agreement = truth::LineVerdict::kMissing, .expected = Near(96, 240)});
  ASSERT_EQ(missing.size(), 1u);
  EXPECT_EQ(missing[0].what, "near(left, cup)");
  EXPECT_EQ(missing[0].expected.caption, "golden: 0.2000 s");
  EXPECT_EQ(missing[0].recognised.caption, "recognised: 0.2000 s, no such event");
  EXPECT_TRUE(missing[0].in_golden && !missing[0].in_run);
  EXPECT_FALSE(Bytes(missing[0].expected).empty());
  EXPECT_NE(Bytes(missing[0].expected), Bytes(missing[0].recognised))
      << "the golden's phase colours the path";

  run_.timeline.events = {Near(96, 240)};
  const auto extra = Draw({.agreement = truth::LineVerdict::kExtra, .actual = Near(96, 240)});
  ASSERT_EQ(extra.size(), 1u);
  EXPECT_EQ(extra[0].expected.caption, "golden: 0.2000 s, no such event");
  EXPECT_NE(Bytes(extra[0].expected), Bytes(extra[0].recognised));
}

}  // namespace
}  // namespace prehend::suite
