// SPDX-License-Identifier: Apache-2.0
// The shipped closed forms: grammar and oracle find what is known on paper, and whoever changes a
// number of both together is found out.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "harness/episode/run/load_run.h"
#include "physics/scene/geometry.h"
#include "tests/witnesses/closed_form_score.h"

namespace prehend::witnesses {
namespace {

constexpr const char* kRoot = PREHEND_SOURCE_DIR;
constexpr const char* kStories = PREHEND_SOURCE_DIR "/tests/witnesses/stories";

ClosedFormEvaluator Grammar(const grammar::Overrides& overrides = {}) {
  return EvaluatedGrammar("pick_and_place",
                          episode::LoadGrammar(kRoot, "pick_and_place", overrides).program);
}

std::vector<ClosedFormScore> Scores(const std::vector<ClosedFormEvaluator>& evaluators) {
  const auto scores = ScoreOnClosedForms(ClosedFormFiles(kStories), evaluators);
  EXPECT_TRUE(scores.has_value()) << grammar::Format(scores.error());
  return scores.value_or(std::vector<ClosedFormScore>{});
}

/// "reach_arc_around_a_plate: reaching(hand, plate)", in whatever sampling.
std::set<std::string> WrongIn(const ClosedFormScore& score) {
  std::set<std::string> wrong;
  for (const ClosedFormRow& row : score.rows)
    for (const JudgedEvent& event : row.events)
      if (!event.begin.right || !event.end.right) wrong.insert(row.form + ": " + event.label);
  return wrong;
}

// What is wrong today; tests/witnesses/README.md explains each. An entry that became right has to
// go.
const std::set<std::string> kWrongInOracle = {
    "idle_with_tremor_and_jitter: reaching(hand, box)",
};
const std::set<std::string> kWrongInGrammar = {
    "idle_with_tremor_and_jitter: reaching(hand, box)",
    "reach_beside_the_corner_of_a_palm: reaching(hand, bead)",
};

std::string Joined(const std::set<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

constexpr double kLeastShare = 0.98;

TEST(ClosedForms, AreFoundByGrammarAndOracle) {
  const std::vector<ClosedFormScore> scores = Scores({Grammar(), EvaluatedOracle()});
  EXPECT_EQ(Joined(WrongIn(scores[0])), Joined(kWrongInGrammar)) << ClosedFormText(scores);
  EXPECT_EQ(Joined(WrongIn(scores[1])), Joined(kWrongInOracle)) << ClosedFormText(scores);
  for (const ClosedFormScore& score : scores)
    EXPECT_GE(score.Right(), kLeastShare * score.Boundaries()) << score.evaluator;
}

TEST(ClosedForms, AreAtLeastFortyStoriesAtAllRates) {
  const std::vector<ClosedFormScore> scores = Scores({EvaluatedOracle()});
  std::map<std::string, std::set<std::string>> stories;
  for (const ClosedFormRow& row : scores[0].rows) stories[row.sampling].insert(row.form);
  for (const char* sampling :
       {"30 Hz", "60 Hz", "120 Hz", "240 Hz", "480 Hz", "120 Hz, frames lost"})
    EXPECT_GE(stories[sampling].size(), 40u) << sampling;
}

TEST(ClosedForms, AreAllOnThePage) {
  std::ifstream file(std::string(kRoot) + "/tests/witnesses/README.md");
  const std::string page(std::istreambuf_iterator<char>(file), {});
  for (const std::string& path : ClosedFormFiles(kStories)) {
    const std::string name = std::filesystem::path(path).stem();
    EXPECT_NE(page.find("| `" + name + "` |"), std::string::npos) << name;
  }
  const std::string wrong = page.substr(0, page.find("## Every story"));
  for (const auto& known : {kWrongInOracle, kWrongInGrammar})
    for (const std::string& line : known)
      EXPECT_NE(wrong.find("`" + line.substr(0, line.find(':')) + "`"), std::string::npos) << line;
}

/// One number, changed in grammar and oracle together, so that they agree with each other.
struct Mutant {
  const char* name;
  grammar::Overrides grammar;
  void (*oracle)(truth::OracleSettings& settings);
};

const Mutant kMutants[] = {
    {"a dead-band of 40 mm",
     {{"reach_slack", "40 mm"}},
     [](truth::OracleSettings& s) { s.reach_dead_band_m = 0.040; }},
    {"slides from 3 cm/s on",
     {{"slide_speed", "3 cm/s"}},
     [](truth::OracleSettings& s) { s.slide_speed_m_per_s = 0.03; }},
    {"a rise of 5 cm",
     {{"lift_rise", "5 cm"}},
     [](truth::OracleSettings& s) { s.pick_up_rise_m = 0.05; }},
    {"put-downs that may go back by 15 mm",
     {{"put_slack", "15 mm"}},
     [](truth::OracleSettings& s) { s.put_down_dead_band_m = 0.015; }},
    {"grips bridged for 150 ms",
     {{"grasp_bridge", "150 ms"}},
     [](truth::OracleSettings& s) { s.grasp_bridge_s = 0.150; }},
    {"a region of interest of 20 cm",
     {{"reach_radius", "20 cm"}},
     [](truth::OracleSettings& s) { s.reach_radius_m = 0.20; }},
    {"contacts bridged for 250 ms",
     {{"contact_bridge", "250 ms"}, {"support_bridge", "250 ms"}},
     [](truth::OracleSettings& s) { s.contact_bridge_s = 0.250; }},
    {"what slides for 6 cm",
     {{"slide_distance", "6 cm"}},
     [](truth::OracleSettings& s) { s.slide_displacement_m = 0.06; }},
};

class NumberOfBoth : public testing::TestWithParam<Mutant> {};

TEST_P(NumberOfBoth, IsFoundOut) {
  const Mutant& mutant = GetParam();
  truth::OracleSettings settings;
  mutant.oracle(settings);
  const std::vector<ClosedFormScore> scores =
      Scores({Grammar(mutant.grammar), EvaluatedOracle(settings)});
  for (const ClosedFormScore& score : scores) {
    std::set<std::string> found_out = WrongIn(score);
    for (const std::string& line : kWrongInOracle) found_out.erase(line);
    for (const std::string& line : kWrongInGrammar) found_out.erase(line);
    EXPECT_FALSE(found_out.empty()) << score.evaluator << " with " << mutant.name;
    RecordProperty(score.evaluator, Joined(found_out));
  }
}

INSTANTIATE_TEST_SUITE_P(Mutants, NumberOfBoth, testing::ValuesIn(kMutants), [](const auto& of) {
  std::string name = of.param.name;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
});

/// Sides are cubes of 2 mm; contacts are said, not computed.
constexpr double kNear_m = 0.0021;

TEST(ClosedForms, WhatAHandTouchesIsWhereItIs) {
  int touches = 0;
  for (const std::string& file : ClosedFormFiles(kStories)) {
    const auto form = ReadClosedForm(file);
    ASSERT_TRUE(form.has_value()) << grammar::Format(form.error());
    const ClosedFormRecording& recording = form->recordings.front();
    for (const physics::Snapshot& frame : recording.frames) {
      for (const physics::ContactPoint& point : frame.contacts) {
        if (point.a.hand == physics::kNone) continue;  // hands come before bodies
        ++touches;
        const physics::HandState& hand = frame.hand(point.a.hand);
        const physics::Pose& X_WL =
            point.a.link == physics::kNone ? hand.palm.X_WB : At(hand.X_WL, point.a.link);
        const double distance_m =
            physics::DistanceTo(recording.scenario.scene.body(point.b.body),
                                frame.body(point.b.body).X_WB.inverse() * X_WL.p_m);
        ASSERT_NEAR(distance_m, 0, kNear_m) << form->name << " at tick " << frame.tick;
      }
    }
  }
  EXPECT_GT(touches, 1000);
}

}  // namespace
}  // namespace prehend::witnesses
