// SPDX-License-Identifier: Apache-2.0
// The main loop: what its caller sees in each step, and the result.
#include "harness/episode/run/run_scenario.h"

#include <nlohmann/json.hpp>

#include "harness/episode/run/load_run.h"
#include "harness/episode/run/segment_recording.h"
#include "harness/episode/sense/episode_format.h"
#include "harness/truth/timeline/event_text.h"
#include "tests/harness/suite/judge/checked_run.h"

namespace prehend::episode {
namespace {

class RunScenarioTest : public suite::CheckedScenario {
 protected:
  void SetUp() override {
    auto loaded = LoadRun(Request(), root_.string());
    ASSERT_TRUE(loaded) << Format(loaded.error());
    loaded_ = std::move(*loaded);
  }

  LoadedRun loaded_;
};

TEST_F(RunScenarioTest, TheCallerSeesEveryTickAndWhatIsSensedInIt) {
  ScenarioRun playing(loaded_.scenario, loaded_.program, {.record = true});
  grammar::Tick last = 0;
  std::vector<grammar::Tick> played, sensed, recorded;
  while (playing.Step()) {
    EXPECT_EQ(playing.snapshot().tick, last + 1);
    last = playing.snapshot().tick;
    played.push_back(last);
    if (!playing.sensed()) continue;
    sensed.push_back(playing.frame().tick);
    EXPECT_EQ(sensed.back(), last);
    EXPECT_EQ(playing.frame().entities.size(), MakeEntityTable(loaded_.scenario).entities.size());
  }
  const RunResult result = playing.Finish();
  EXPECT_EQ(result.ticks, last);
  EXPECT_EQ(result.ticks, 48) << "0.1 s at 480 Hz";
  for (const physics::Snapshot& snapshot : result.recording) recorded.push_back(snapshot.tick);
  EXPECT_EQ(recorded, played);
  EXPECT_EQ(sensed.size(), 24u) << "0.1 s at 240 Hz";
  EXPECT_EQ(playing.snapshot().tick, last) << "the last snapshot stays";
}

TEST_F(RunScenarioTest, TheResultIsThatOfTheCallersLoop) {
  ScenarioRun playing(loaded_.scenario, loaded_.program);
  while (playing.Step()) {
  }
  const RunResult stepped = playing.Finish();
  const RunResult run = RunScenario(loaded_.scenario, loaded_.program, {.record = true});
  EXPECT_EQ(run.status.kind, physics::RunStatus::Kind::kCompleted);
  EXPECT_FALSE(run.timeline.events.empty());
  EXPECT_EQ(stepped.state_hash, run.state_hash);
  EXPECT_EQ(truth::TimelineJson(stepped.timeline), truth::TimelineJson(run.timeline));
  EXPECT_TRUE(stepped.recording.empty()) << "nobody asked for it";
  EXPECT_EQ(stepped.seconds.total, 0) << "nobody asked for it";
}

TEST_F(RunScenarioTest, TheTimeOfItsPartsIsMeasured) {
  const RunSeconds seconds =
      RunScenario(loaded_.scenario, loaded_.program, {.measure = true}).seconds;
  EXPECT_GT(seconds.physics, 0);
  EXPECT_GT(seconds.sensing, 0);
  EXPECT_GT(seconds.grammar, 0);
  EXPECT_DOUBLE_EQ(seconds.total, seconds.physics + seconds.sensing + seconds.grammar);
}

TEST_F(RunScenarioTest, ARecordingIsSegmentedAsTheRunWas) {
  const RunResult run = RunScenario(loaded_.scenario, loaded_.program, {.record = true});
  const grammar::Timeline again =
      Resegment(loaded_.scenario, run.recording, loaded_.program, run.ticks + 1);
  EXPECT_EQ(truth::TimelineJson(again), truth::TimelineJson(run.timeline));
}

TEST_F(RunScenarioTest, AGrammarThatCannotWatchTheSceneIsAFailedRun) {
  scenario::Scenario& scenario = loaded_.scenario;
  for (int i = 0; i < 50; ++i) {
    scenario.scene.bodies.push_back(scenario.scene.bodies.front());
    scenario.scene.bodies.back().name = "copy_" + std::to_string(i);
    scenario.body_classes.push_back(scenario.body_classes.front());
    scenario.body_part_of.push_back(grammar::kNoEntity);
  }
  const auto compiled = grammar::Compile(
      {.file = "far.grammar",
       .text = "grammar far\nevent far(a: Entity, b: Entity, c: Entity, d: Entity)\n"
               "  while distance(a, b) > 3 m and distance(c, d) > 3 m\n"},
      {});
  ASSERT_TRUE(compiled.program) << Format(compiled.diagnostics);
  const RunResult run = RunScenario(scenario, compiled.program);
  EXPECT_EQ(run.status.kind, physics::RunStatus::Kind::kFailed);
  const std::string n = std::to_string(MakeEntityTable(scenario).entities.size());
  EXPECT_EQ(
      run.status.reason,
      "the grammar cannot be evaluated on this scene: more than 1000000 bindings with those of "
      "'far(a: Entity, b: Entity, c: Entity, d: Entity)': there are " +
          n + " for a, " + n + " for b, " + n + " for c, " + n +
          " for d; give the roles narrower classes");
  EXPECT_EQ(run.status.advice, "use fewer entities or rules with narrower role classes");
  EXPECT_EQ(run.ticks, 0);
}

}  // namespace
}  // namespace prehend::episode
