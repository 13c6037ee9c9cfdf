// SPDX-License-Identifier: Apache-2.0
// What a golden says about where it comes from, on a real run that is then falsified.
#include "harness/derivation.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "harness/golden.h"
#include "harness/prepare_run.h"

namespace prehend::harness {
namespace {

class DerivationTest : public testing::Test {
 protected:
  void SetUp() override {
    const RunRequest request{.scenario_file = PREHEND_SOURCE_DIR
                             "/scenarios/pick_and_place/milk_carton_wrap.yaml"};
    auto read = LoadRun(request, PREHEND_SOURCE_DIR);
    ASSERT_TRUE(read.value) << grammar::Format(read.diagnostics);
    loaded = std::move(*read.value);
    run = RunScenario(loaded.scenario, loaded.program, {.record = true});
  }
  grammar::NamedEvent& Find(const std::string& event) {
    return *std::ranges::find(run.timeline.events, event, &grammar::NamedEvent::event);
  }

  LoadedRun loaded;
  RunResult run;
};

TEST_F(DerivationTest, TheRunAsItWasFollows) {
  const Derivation derivation = Derive(loaded.scenario, *loaded.program, run);
  EXPECT_TRUE(derivation.agrees) << derivation.lines.back();
  ASSERT_EQ(derivation.lines.size(), 1u);
  const std::string all = std::to_string(run.timeline.events.size());
  EXPECT_EQ(derivation.lines[0], "oracle: " + all + " of " + all +
                                     " events follow from the definitions of docs/events.md, "
                                     "boundaries at most 0.0 ms off");
}

TEST_F(DerivationTest, AShiftedBoundaryDoesNot) {
  Find("picking_up").interval.begin += 20;
  const Derivation derivation = Derive(loaded.scenario, *loaded.program, run);
  EXPECT_FALSE(derivation.agrees);
  ASSERT_EQ(derivation.notes.size(), 1u);
  EXPECT_EQ(derivation.notes[0].text, "+41.7/+0.0ms");
  EXPECT_EQ(derivation.notes[0].event.interval, Find("picking_up").interval);
}

TEST_F(DerivationTest, AMissingAndAnInventedEventDoNot) {
  Find("transporting").event = "sliding";
  const Derivation derivation = Derive(loaded.scenario, *loaded.program, run);
  EXPECT_FALSE(derivation.agrees);
  ASSERT_EQ(derivation.notes.size(), 2u);
  EXPECT_EQ(derivation.notes[0].text, kNotOfOracle);
  EXPECT_EQ(derivation.notes[0].event.event, "sliding");
  EXPECT_EQ(derivation.notes[1].text, kOnlyOracle);
  EXPECT_EQ(derivation.notes[1].event.event, "transporting");
}

TEST_F(DerivationTest, EventsWithoutADefinitionAreCountedNotJudged) {
  run.timeline.events.push_back({.event = "stirring", .roles = {}, .interval = {10, 20}});
  const Derivation derivation = Derive(loaded.scenario, *loaded.program, run);
  EXPECT_TRUE(derivation.agrees);
  EXPECT_NE(derivation.lines[0].find("(1 events of other kinds not judged)"), std::string::npos)
      << derivation.lines[0];
}

TEST(RenewedDerivation, KeepsWhatPeopleWrote) {
  EXPECT_EQ(RenewedDerivation({"seen in the picture", "oracle: old"},
                              {.agrees = true, .lines = {"oracle: new"}, .notes = {}}),
            (std::vector<std::string>{"seen in the picture", "oracle: new"}));
}

}  // namespace
}  // namespace prehend::harness
