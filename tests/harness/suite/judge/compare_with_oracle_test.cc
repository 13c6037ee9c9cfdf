// SPDX-License-Identifier: Apache-2.0
// What a golden says about where it comes from, on a real run that is then falsified.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "harness/episode/run/load_run.h"
#include "harness/suite/judge/validate_golden.h"
#include "harness/truth/oracle/oracle.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::suite {
namespace {

class DerivationTest : public testing::Test {
 protected:
  void SetUp() override {
    const episode::RunRequest request{.scenario_file = PREHEND_SOURCE_DIR
                                      "/scenarios/pick_and_place/milk_carton_wrap.yaml"};
    auto read = episode::LoadRun(request, PREHEND_SOURCE_DIR);
    ASSERT_TRUE(read) << grammar::Format(ErrorsOf(read));
    loaded = std::move(*read);
    run = episode::RunScenario(loaded.scenario, loaded.program, {.record = true});
  }
  grammar::NamedEvent& Find(const std::string& event) {
    return *std::ranges::find(run.timeline.events, event, &grammar::NamedEvent::event);
  }

  std::string When(const std::string& event) {
    return truth::IntervalText(Find(event).interval, run.timeline.ticks_per_second);
  }
  OracleComparison Compared() const {
    return CompareWithOracle(loaded.scenario, *loaded.program, run);
  }

  episode::LoadedRun loaded;
  episode::RunResult run;
};

TEST_F(DerivationTest, TheRunAsItWasFollows) {
  const OracleComparison compared = Compared();
  EXPECT_EQ(compared.Differing(), 0) << GroundTruthText(compared);
  EXPECT_EQ(GroundTruthText(compared), "");
  const std::string all = std::to_string(run.timeline.events.size());
  EXPECT_EQ(OracleLine(compared), "oracle: " + all + " of " + all +
                                      " events follow from the definitions of docs/events.md");
}

TEST_F(DerivationTest, ABoundaryOutsideItsBandDoesNot) {
  // The lift leaves its region at once: 10 or 14 cm up are a few hundredths of a second apart.
  Find("picking_up").interval.begin += 20;
  const OracleComparison late = Compared();
  EXPECT_EQ(late.Differing(), 1);
  EXPECT_EQ(GroundTruthText(late),
            "ground truth: picking_up(right_hand, milk) begins 41.7 ms earlier than recognised; "
            "its end agrees (recognised " +
                When("picking_up") + ")\n");
  EXPECT_NE(OracleLine(late).find("; 1 more begins or ends up to 41.7 ms elsewhere"),
            std::string::npos)
      << OracleLine(late);
  Find("picking_up").interval.end -= 40;
  EXPECT_NE(GroundTruthText(Compared())
                .find(" begins 41.7 ms earlier than recognised and ends 56.2 ms later than "
                      "recognised (recognised "),
            std::string::npos)
      << GroundTruthText(Compared());
}

TEST_F(DerivationTest, AMissingAndAnInventedEventDoNot) {
  const std::string when = When("transporting");
  const grammar::Timeline truth =
      truth::TrueTimeline(loaded.scenario.scene, run.recording, run.ticks + 1);
  const auto carry =
      std::ranges::find(truth.events, "transporting", &grammar::NamedEvent::event)->interval;
  Find("transporting").event = "sliding";
  const OracleComparison compared = Compared();
  EXPECT_EQ(compared.Differing(), 2);
  EXPECT_EQ(GroundTruthText(compared),
            "ground truth: no sliding(right_hand, milk), recognised " + when +
                "\nground truth: transporting(right_hand, milk) " +
                truth::IntervalText(carry, truth.ticks_per_second) + ", not recognised\n");
  EXPECT_EQ(AcceptedDiffering({OracleLine(compared)}), 2);
}

TEST_F(DerivationTest, EventsWithoutADefinitionAreCountedNotJudged) {
  run.timeline.events.push_back({.event = "stirring", .roles = {}, .interval = {10, 20}});
  const OracleComparison compared = Compared();
  EXPECT_EQ(compared.Differing(), 0);
  EXPECT_TRUE(OracleLine(compared).ends_with("docs/events.md (1 event of other kinds not judged)"))
      << OracleLine(compared);
}

TEST(CompareWithOracle, JudgesFurniture) {
  const episode::RunRequest request{.scenario_file = PREHEND_SOURCE_DIR
                                    "/scenarios/body/foot_closes_the_drawer.yaml"};
  auto read = episode::LoadRun(request, PREHEND_SOURCE_DIR);
  ASSERT_TRUE(read) << grammar::Format(ErrorsOf(read));
  episode::RunResult run = episode::RunScenario(read->scenario, read->program, {.record = true});
  const auto compared = [&] { return CompareWithOracle(read->scenario, *read->program, run); };
  EXPECT_EQ(compared().Differing(), 0) << GroundTruthText(compared());
  const auto closing =
      std::ranges::find(run.timeline.events, "closing", &grammar::NamedEvent::event);
  ASSERT_NE(closing, run.timeline.events.end());
  // Half a window too soon: before the foot touches it.
  closing->interval.begin -= 24;
  EXPECT_EQ(compared().Differing(), 1);
  EXPECT_NE(GroundTruthText(compared()).find("ground truth: closing(drawer) begins 47.9 ms later"),
            std::string::npos)
      << GroundTruthText(compared());
  // Closed by nobody.
  closing->interval.begin += 24;
  std::erase_if(run.timeline.events, [](const auto& event) { return event.event == "closed_by"; });
  EXPECT_EQ(compared().Differing(), 1);
  EXPECT_NE(GroundTruthText(compared()).find("ground truth: closed_by(drawer, anna_right_toes) "),
            std::string::npos)
      << GroundTruthText(compared());
}

/// Snapshots that share nothing and do not know what moved: everything is read anew in each.
std::vector<physics::Snapshot> Unshared(std::vector<physics::Snapshot> recording) {
  for (physics::Snapshot& snapshot : recording) {
    if (snapshot.resting)
      snapshot.contacts.insert(snapshot.contacts.end(), snapshot.resting->begin(),
                               snapshot.resting->end());
    snapshot.resting = nullptr;
    snapshot.moved_tick.clear();
  }
  return recording;
}

TEST(CompareWithOracle, WhatRestsBearsAsIfItWereReadAnew) {
  for (const char* name :
       {"long/two_cans_change_places", "actions/one_hand_holds_still_while_the_other_one_places"}) {
    SCOPED_TRACE(name);
    auto read = episode::LoadRun(
        {.scenario_file = fmt::format(PREHEND_SOURCE_DIR "/scenarios/{}.yaml", name)},
        PREHEND_SOURCE_DIR);
    ASSERT_TRUE(read) << grammar::Format(ErrorsOf(read));
    const physics::Scene& scene = read->scenario.scene;
    const episode::RunResult run =
        episode::RunScenario(read->scenario, read->program, {.record = true});
    EXPECT_TRUE(
        std::ranges::any_of(run.recording, [](const auto& now) { return now.resting != nullptr; }));
    const auto shared = truth::PossibleTimelines(scene, run.recording, run.ticks + 1);
    const auto anew = truth::PossibleTimelines(scene, Unshared(run.recording), run.ticks + 1);
    ASSERT_EQ(shared.size(), anew.size());
    for (std::size_t i = 0; i < shared.size(); ++i) {
      ASSERT_EQ(shared[i].events.size(), anew[i].events.size()) << i;
      for (std::size_t k = 0; k < shared[i].events.size(); ++k) {
        EXPECT_EQ(shared[i].events[k].Label(), anew[i].events[k].Label()) << i;
        EXPECT_EQ(shared[i].events[k].interval, anew[i].events[k].interval) << i;
      }
    }
  }
}

TEST(AcceptedDiffering, IsReadFromTheLineOfAGolden) {
  EXPECT_EQ(AcceptedDiffering({}), 0);
  EXPECT_EQ(AcceptedDiffering({"seen in the picture", "12 of 13 events follow"}), 0);
  EXPECT_EQ(AcceptedDiffering({"by eye", "oracle: 12 of 13 events follow from .., boundaries"}), 1);
  EXPECT_EQ(AcceptedDiffering({"oracle: 9 of 9 events follow from the definitions of "
                               "docs/events.md; 1 more begins or ends up to 9.9 ms elsewhere; 3 "
                               "that follow are not recognised (2 events of other kinds not "
                               "judged)"}),
            3);
  EXPECT_EQ(AcceptedDiffering({"oracle: many events follow"}), 0);
}

TEST(DifferingText, CountsEvents) {
  EXPECT_EQ(DifferingText(0), "no event differs from the ground truth");
  EXPECT_EQ(DifferingText(1), "1 event differs from the ground truth");
  EXPECT_EQ(DifferingText(2), "2 events differ from the ground truth");
}

TEST(RenewedDerivation, KeepsWhatPeopleWrote) {
  EXPECT_EQ(RenewedDerivation({"seen in the picture", "oracle: old"}, "oracle: new"),
            (std::vector<std::string>{"seen in the picture", "oracle: new"}));
}

}  // namespace
}  // namespace prehend::suite
