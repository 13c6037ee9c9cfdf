// SPDX-License-Identifier: Apache-2.0
// The score on closed forms as a maintainer meets it: tables, lists of what is wrong, errors.
#include "tests/witnesses/closed_form_score.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "harness/episode/run/load_run.h"

namespace prehend::witnesses {
namespace {

constexpr const char* kStands = R"(closed_form: stands
shows: A box stands.
lasts_s: 1
entities:
  table: {box: {size_m: [1, 1, 0.04]}, fixed: true, at_m: [0, 0, -0.02]}
  box: {box: {size_m: [0.1, 0.1, 0.1]}, mass_kg: 0.5, at_m: [0, 0, 0.05]}
hands:
  hand: {at_m: [1, 0, 1]}
contacts:
  - {between: [box, table], while: t < 0.6}
sampled: [{hz: 60}]
truth:
  - contact(box, table): [0, 0.5]
  - supported_by(box, table): [0, 0.6]
)";

Result<std::vector<ClosedFormScore>> ScoreOf(const std::string& text) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) /
      (std::string("closed_form_score_") +
       testing::UnitTest::GetInstance()->current_test_info()->name());
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "stands.yaml") << text;
  return ScoreOnClosedForms(
      ClosedFormFiles(folder),
      {EvaluatedGrammar("contact", episode::LoadGrammar(PREHEND_SOURCE_DIR, "contact", {}).program),
       EvaluatedOracle()});
}

TEST(ClosedFormScore, GrammarsAndOracleAreScored) {
  const auto scores = ScoreOf(kStands);
  ASSERT_TRUE(scores) << grammar::Format(scores.error());
  const std::string text = ClosedFormText(*scores);
  EXPECT_NE(text.find("all                      3 of 4 (75.0 %)         3 of 4 (75.0 %)\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("\nwrong in contact\n  stands: contact(box, table): in 1 of 1 samplings: "
                      "end +100.0 ms\n\nwrong in oracle\n"),
            std::string::npos)
      << text;
  const auto json = ClosedFormJson(*scores);
  EXPECT_EQ(json["closed_forms"][1]["name"], "oracle");
  EXPECT_EQ(json["closed_forms"][1]["right"], 3);
  EXPECT_EQ(json["closed_forms"][1]["wrong"][0]["end"]["expected_s"], 0.5);
}

TEST(ClosedFormScore, WhatCannotBeReadIsAnError) {
  const auto scores = ScoreOf(std::string(kStands) + "  - contact(box, tabel): [0, 1]\n");
  ASSERT_FALSE(scores);
  EXPECT_NE(grammar::Format(scores.error()).find("error: unknown name 'tabel'"), std::string::npos)
      << grammar::Format(scores.error());
}

ClosedFormScore Mine() {
  ClosedFormScore score{.evaluator = "mine", .rows = {}};
  JudgedEvent event{.label = "reaching(hand, cup)"};
  event.begin.right = true;
  score.rows.push_back({"story", "240 Hz", {event}});
  return score;
}

TEST(ByClosedForms, CountsBoundaries) {
  const measure::Evaluation evaluation = ByClosedForms(Mine());
  EXPECT_EQ(evaluation.by_event.at("reaching").of, 2);
  EXPECT_EQ(evaluation.by_event.at("reaching").confirmed, 1);
}

TEST(EvaluatorTable, HasARowOfClosedFormsBelowThoseOfScore) {
  const auto score = nlohmann::json::parse(
      R"({"witnesses": [{"witness": "claims", "proves": "what was said",
          "grammars": [{"grammar": "mine", "of": 8, "confirmed": 7}]}]})");
  EXPECT_EQ(EvaluatorTableWith(score, {Mine()}),
            "| evaluator | mine | what it proves |\n"
            "|---|---|---|\n"
            "| claims | 7 of 8 (87.5 %) | what was said |\n"
            "| closed forms | 1 of 2 (50.0 %) | boundaries known on paper are found to the frame "
            "|\n");
}

}  // namespace
}  // namespace prehend::witnesses
