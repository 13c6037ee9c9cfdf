// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/check/explained.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/harness/suite/judge/checked_run.h"

namespace prehend::suite {
namespace {

constexpr const char* kGrammar = R"(grammar falls
event quick(a: Movable) while speed(a) > 0.2 m/s
)";

class ExplainedTest : public CheckedScenario {
 protected:
  /// The carton falls until the episode ends.
  CheckedRun Falls() {
    episode::RunRequest request = Request();
    request.grammar = Write("falls.grammar", kGrammar);
    std::string scenario = kCartonStands;
    const std::string on = "on: table, at_m: [0.15, 0.15]";
    scenario.replace(scenario.find(on), on.size(), "at_m: [0.15, 0.15, 0.86]");
    Write("scenarios/rest/carton_stands.yaml", scenario);
    auto loaded = episode::LoadRun(request, root_.string());
    EXPECT_TRUE(loaded) << Format(loaded.error());
    CheckedRun checked{
        .id = "rest/carton_stands", .loaded = std::move(*loaded), .result = {}, .explain = {}};
    checked.result =
        episode::RunScenario(checked.loaded.scenario, checked.loaded.program, {.record = true});
    return checked;
  }
  static Explained Of(const CheckedRun& checked, const truth::Golden& golden) {
    const truth::Comparison comparison = truth::Compare(golden, checked.result.timeline, 4);
    return Explain(checked.loaded.scenario, checked.result, checked.loaded.program, comparison);
  }
};

TEST_F(ExplainedTest, SaysWhatTurnedAndShowsTheSignalThatDecided) {
  const CheckedRun checked = Falls();
  const Explained explained = Of(checked, {});
  ASSERT_FALSE(explained.events.empty());
  const ExplainedEvent& event = explained.events.front();
  EXPECT_EQ(event.event, "quick(carton)");
  EXPECT_TRUE(event.began.starts_with("speed(carton) > 0.2 m/s rose to ")) << event.began;
  ASSERT_FALSE(explained.differences.empty());
  const ExplainedDifference& difference = explained.differences.front();
  EXPECT_EQ(difference.what, "extra quick(carton)");
  EXPECT_TRUE(difference.text.starts_with("quick(carton)  ")) << difference.text;
  ASSERT_EQ(difference.signals.size(), 2u) << "it is quick up to the end of the episode";
  const DecidingSignal& signal = difference.signals.front();
  EXPECT_EQ(signal.tick, event.begin);
  EXPECT_EQ(signal.unit, "m/s");
  const auto at = std::ranges::find(signal.ticks, signal.tick) - signal.ticks.begin();
  ASSERT_GT(at, 0);
  EXPECT_GT(signal.values[at], signal.limits[at]);
  EXPECT_LE(signal.values[at - 1], signal.limits[at - 1]);
  EXPECT_EQ(signal.limits[at], 0.2);
  EXPECT_GT(signal.ticks.back(), signal.tick) << "it goes on afterwards";
  const DecidingSignal& robustness = difference.signals.back();
  EXPECT_EQ(robustness.clause, "robustness of quick(carton)");
  EXPECT_EQ(robustness.unit, "m/s");
  for (std::size_t i = 0; i < robustness.ticks.size(); ++i)
    EXPECT_EQ(robustness.values[i] > 0, robustness.ticks[i] >= event.begin) << i;
}

TEST_F(ExplainedTest, SaysWhyWhatWasExpectedDidNotHappen) {
  const CheckedRun checked = Falls();
  truth::Golden golden{.scenario = "s", .grammar = "falls", .ticks_per_second = 480};
  for (const grammar::NamedEvent& event : checked.result.timeline.events)
    golden.events.push_back({.event = event, .tolerance_ms = {}, .because = {}, .comments = {}});
  grammar::NamedEvent expected = checked.result.timeline.events.front();
  expected.interval = {2, 10};
  golden.events.push_back({.event = expected, .tolerance_ms = {}, .because = {}, .comments = {}});
  const Explained explained = Of(checked, golden);
  ASSERT_EQ(explained.differences.size(), 1u);
  EXPECT_EQ(explained.differences.front().what, "missing quick(carton)");
  EXPECT_NE(explained.differences.front().text.find("did not happen at"), std::string::npos)
      << explained.differences.front().text;
}

TEST_F(ExplainedTest, ComesOutOfAnotherProcessAsItWas) {
  const Explained explained = Of(Falls(), {});
  const nlohmann::json packed = explained;
  const auto again = packed.get<Explained>();
  EXPECT_EQ(nlohmann::json(again), packed);
  EXPECT_EQ(again.differences.size(), explained.differences.size());
}

}  // namespace
}  // namespace prehend::suite
