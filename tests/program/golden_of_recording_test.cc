// SPDX-License-Identifier: Apache-2.0
// Goldens of recordings of trackers, as docs/motion-capture.md says.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/program/program.h"

namespace prehend::house {
namespace {

namespace fs = std::filesystem;

bool Has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class GoldenOfARecording : public testing::Test {
 protected:
  GoldenOfARecording() {
    const std::string docs = PREHEND_SOURCE_DIR "/docs/motion_capture";
    EXPECT_EQ(Prehend({"import", docs + "/poses.csv", "--map", docs + "/bodies.yaml", "-o", take_})
                  .exit_code,
              0);
  }
  ~GoldenOfARecording() override { fs::remove_all(folder_); }

  Said Check(std::vector<std::string> options = {}) const {
    options.insert(options.begin(), {"check", take_, "--report", (folder_ / "page").string()});
    return Prehend(options);
  }

  /// Also where CI is set, and goldens are not accepted otherwise.
  Said Accept(std::vector<std::string> options) const {
    options.insert(options.begin(), {"accept", take_});
    return Prehend(options, {"CI="});
  }

  const fs::path folder_ =
      FreshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
  const std::string take_ = (folder_ / "milk.jsonl").string();
  const fs::path golden_ = folder_ / "milk.timeline";
};

TEST_F(GoldenOfARecording, IsReviewedAcceptedAndChecked) {
  const Said pending = Check();
  EXPECT_EQ(pending.exit_code, 5) << pending.out;
  EXPECT_TRUE(Has(pending.out, "next: prehend review " + take_)) << pending.out;
  EXPECT_FALSE(fs::exists(golden_));
  const Said review = Prehend({"review", take_, "--json"});
  EXPECT_EQ(review.exit_code, 5);
  const auto waiting = nlohmann::json::parse(review.out)["pending"];
  ASSERT_EQ(waiting.size(), 1u);
  EXPECT_EQ(waiting[0]["kind"], "new");
  EXPECT_TRUE(Has(waiting[0]["text"], "putting_down")) << waiting[0]["text"];
  const std::string seen = waiting[0]["fingerprint"];

  const Said other = Accept({"--reviewed", "0123456789abcdef", "--reason", "seen"});
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_TRUE(Has(other.err, "the recording now yields " + seen)) << other.err;
  EXPECT_FALSE(fs::exists(golden_));
  const Said accepted = Accept({"--reviewed", seen, "--reason", "seen"});
  EXPECT_EQ(accepted.exit_code, 0) << accepted.err;
  EXPECT_TRUE(Has(ReadFile(golden_), "\"seen\"")) << ReadFile(golden_);
  EXPECT_EQ(Check().exit_code, 0);
  EXPECT_EQ(Prehend({"review", take_}).exit_code, 0);
  const std::string before = ReadFile(golden_);
  const Said again = Accept({"--reason", "again"});
  EXPECT_TRUE(Has(again.out, "nothing to accept")) << again.out;
  EXPECT_EQ(ReadFile(golden_), before);
}

// As of a scenario, also where the events are those of the golden.
TEST_F(GoldenOfARecording, BreaksALawOfItsGrammarOrKeepsIt) {
  const fs::path grammar = folder_ / "lawful.grammar";
  const std::string rules =
      "grammar lawful\nuse pick_and_place_from_motion\n"
      "law kept(hand: Hand, object: Movable) grasping(hand, object) lies inside ";
  const std::vector<std::string> options = {"--grammar", grammar.string()};
  WriteFile(grammar, rules + "reaching(hand, object)\n");
  ASSERT_EQ(Accept({"--grammar", grammar.string(), "--reason", "seen"}).exit_code, 0);
  const Said broken = Check(options);
  EXPECT_EQ(broken.exit_code, 1) << broken.out;
  EXPECT_TRUE(Has(broken.out, "a law of the grammar is violated, kept")) << broken.out;
  WriteFile(grammar, rules + "contact(hand, object)\n");
  EXPECT_EQ(Check(options).exit_code, 0);
}

TEST_F(GoldenOfARecording, ADifferenceIsShownWithItsCauseAndKeepsWhatPeopleWrote) {
  ASSERT_EQ(Accept({"--reason", "seen"}).exit_code, 0);
  const Said changed = Check({"--set", "reach_radius=10cm"});
  EXPECT_EQ(changed.exit_code, 1);
  EXPECT_TRUE(Has(changed.out, "shifted reaching(right_hand, milk)")) << changed.out;
  EXPECT_TRUE(Has(changed.out, "1. --set reach_radius=10cm")) << changed.out;
  WriteFile(golden_, Replaced(ReadFile(golden_), "fixation        0.66250",
                              "# the hand is open\nfixation        0.56250"));
  const Said differs = Check();
  EXPECT_EQ(differs.exit_code, 1);
  EXPECT_TRUE(Has(differs.out, "begin +100.0 ms")) << differs.out;
  EXPECT_EQ(Accept({"--reason", "the video has it"}).exit_code, 0);
  EXPECT_TRUE(Has(ReadFile(golden_), "# the hand is open\nfixation        0.66250"))
      << ReadFile(golden_);
  EXPECT_EQ(Check().exit_code, 0);
}

TEST_F(GoldenOfARecording, WhatIsWrongIsSaidAndNothingIsWritten) {
  const Said played = Check({"--repeat=2"});
  EXPECT_EQ(played.exit_code, 2);
  EXPECT_TRUE(Has(played.err, "plays scenarios; " + take_ + " is a recording")) << played.err;
  const Said unsteady = Accept({"--reason", "seen", "--unsteady", "why"});
  EXPECT_EQ(unsteady.exit_code, 2);
  EXPECT_FALSE(fs::exists(golden_));
  WriteFile(golden_,
            "# scenario: another\n# grammar: pick_and_place_from_motion\n"
            "# ticks_per_second: 10000\n");
  const Said another = Check();
  EXPECT_EQ(another.exit_code, 2);
  EXPECT_TRUE(Has(another.out, "milk.timeline:1:13: error: this golden says it is of 'another'"))
      << another.out;
  EXPECT_EQ(Accept({"--reason", "seen"}).exit_code, 2);
  EXPECT_TRUE(Has(ReadFile(golden_), "another"));
}

TEST_F(GoldenOfARecording, MayBeOfAnotherGrammarThanTheRecordingNames) {
  const std::string own = (folder_ / "own.grammar").string();
  WriteFile(own,
            "grammar own\nevent far(hand: Hand, object: Movable)\n"
            "  while distance(hand, object) > 20 cm\n");
  EXPECT_TRUE(
      Has(Check({"--grammar", own}).out, "next: prehend review " + take_ + " --grammar " + own));
  const Said review = Prehend({"review", take_, "--grammar", own});
  EXPECT_EQ(review.exit_code, 5) << review.err;
  EXPECT_TRUE(Has(review.out, "far  0.00000  0.51250  hand=right_hand  object=milk")) << review.out;
  EXPECT_TRUE(Has(review.out, " --grammar " + own + " --reason")) << review.out;
  ASSERT_EQ(Accept({"--grammar", own, "--reason", "seen"}).exit_code, 0);
  EXPECT_TRUE(Has(ReadFile(golden_), "# grammar: own\n")) << ReadFile(golden_);
  EXPECT_EQ(Check({"--grammar", own}).exit_code, 0);
  const Said without = Check();
  EXPECT_EQ(without.exit_code, 1);
  EXPECT_TRUE(Has(without.out,
                  "the golden is of grammar 'own', and this is what "
                  "'pick_and_place_from_motion' recognises; --grammar names another "
                  "one"))
      << without.out;
  ASSERT_EQ(Accept({"--reason", "seen"}).exit_code, 0);
  ASSERT_EQ(Check().exit_code, 0);
  WriteFile(golden_,
            Replaced(ReadFile(golden_), "# grammar: pick_and_place_from_motion", "# grammar: own"));
  const Said equal = Check();
  EXPECT_EQ(equal.exit_code, 2);
  EXPECT_TRUE(Has(equal.out, "the golden is of another grammar")) << equal.out;
  ASSERT_EQ(Accept({"--reason", "its own grammar"}).exit_code, 0);
  EXPECT_EQ(Check().exit_code, 0);
  const Said scenario =
      Prehend({"accept", "milk_carton_wrap", "--grammar", own, "--reason", "x"}, {"CI="});
  EXPECT_EQ(scenario.exit_code, 2);
  EXPECT_TRUE(Has(scenario.err, "--grammar concerns recordings")) << scenario.err;
  EXPECT_EQ(Prehend({"review", "milk_carton_wrap", "--grammar", own}).exit_code, 2);
  const Said all = Prehend({"review", "--grammar", own});
  EXPECT_EQ(all.exit_code, 2);
  EXPECT_TRUE(Has(all.err, "--grammar concerns recordings")) << all.err;
}

TEST_F(GoldenOfARecording, RecordingsAndScenariosAreCheckedTogether) {
  ASSERT_EQ(Accept({"--reason", "seen"}).exit_code, 0);
  const Said both = Check({"milk_carton_wrap", "--no-pictures"});
  EXPECT_EQ(both.exit_code, 0) << both.out;
  EXPECT_TRUE(Has(both.out, "2 passed, 0 failed")) << both.out;
}

}  // namespace
}  // namespace prehend::house
