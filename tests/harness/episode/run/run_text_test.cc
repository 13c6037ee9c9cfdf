// SPDX-License-Identifier: Apache-2.0
// A run for people and for programs, on a hand-made result.
#include "harness/episode/run/run_text.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace prehend::episode {
namespace {

RunResult SampleRun() {
  RunResult run;
  run.status = {.kind = physics::RunStatus::Kind::kCompleted,
                .tick = 960,
                .entity = {},
                .reason = {},
                .advice = {}};
  run.ticks = 960;
  run.state_hash = 0xfedcba9876543210;
  run.timeline = {
      .ticks_per_second = 480,
      .events = {{.event = "contact",
                  .roles = {{"a", "cup"}, {"b", "table"}},
                  .interval = {0, 961},
                  .decided = 961,
                  .open_end = true},
                 {.event = "grasping",
                  .roles = {{"hand", "right_hand"}, {"object", "cup"}, {"style", "wrap"}},
                  .interval = {120, 480},
                  .decided = 510}}};
  return run;
}

TEST(RunText, TheTableIsAlignedAndEndsWithTheStatus) {
  EXPECT_EQ(RunTable(SampleRun()),
            "event     begin_s  end_s   roles\n"
            "contact   0.0000   2.0021  a=cup            b=table                 open_end\n"
            "grasping  0.2500   1.0000  hand=right_hand  object=cup  style=wrap\n"
            "completed: 2.0000 s, 960 ticks\n");
}

TEST(RunText, JsonKeepsTheContract) {
  const OrderedJson json = RunJson({.name = "x", .grammar = "pick_and_place"}, SampleRun());
  EXPECT_EQ(json["scenario"], "x");
  EXPECT_EQ(json["status"], "completed");
  EXPECT_EQ(json["ticks_per_second"], 480);
  EXPECT_EQ(json["ticks"], 960);
  EXPECT_EQ(json["state_hash"], "0xfedcba9876543210");
  EXPECT_EQ(json["grammar"], "pick_and_place");
  EXPECT_FALSE(json.contains("failure"));
  EXPECT_EQ(
      json["events"][1].dump(),
      R"({"event":"grasping","roles":{"hand":"right_hand","object":"cup"},"attributes":{"style":"wrap"},)"
      R"("begin_tick":120,"end_tick":480,"begin_s":0.25,"end_s":1.0,"decided_tick":510,"open_end":false})");
}

TEST(RunText, NotesNameTheirHand) {
  scenario::Scenario scenario;
  scenario.scene.hands.push_back({.name = "right_hand", .model = {}, .X_WH = {}});
  RunResult run = SampleRun();
  run.notes = {{480, physics::HandIndex(0), "it has closed"},
               {720, physics::kNone, "anna: move_limb: out of reach"},
               {960, physics::HandIndex(7), "x"}};
  EXPECT_EQ(NoteLines(scenario, run),
            (std::vector<std::string>{"note: 1.0000 s: right_hand: it has closed",
                                      "note: 1.5000 s: anna: move_limb: out of reach",
                                      "note: 2.0000 s: x"}))
      << "the last one is of a damaged file";
}

TEST(RunText, AFailedRunNamesEntityTickReasonAndAdvice) {
  RunResult run = SampleRun();
  run.status = {.kind = physics::RunStatus::Kind::kFailed,
                .tick = 240,
                .entity = "cup",
                .reason = "runaway speed",
                .advice = "lower the gains"};
  EXPECT_EQ(StatusText(run), "failed at 0.5000 s (tick 240): cup: runaway speed; lower the gains");
  const OrderedJson json = RunJson(HeadingOf(scenario::Scenario(), run), run);
  EXPECT_EQ(json["status"], "failed");
  EXPECT_EQ(json["failure"].dump(),
            R"({"tick":240,"entity":"cup","reason":"runaway speed","advice":"lower the gains"})");
}

TEST(RunText, SharesAreOfTheMeasuredTime) {
  const Measurement measurement{
      .seconds = {.physics = 0.15, .sensing = 0.03, .grammar = 0.02, .total = 0.2},
      .simulated_s = 5,
      .peak_memory_kib = 51200};
  EXPECT_EQ(MeasurementText(measurement),
            "measured: 25.0 times real time; physics 75.0 %, sensing 15.0 %, grammar 10.0 % of "
            "0.200 s; peak memory 50 MiB\n");
  EXPECT_EQ(MeasurementJson(measurement)["times_real_time"], 25.0);
}

}  // namespace
}  // namespace prehend::episode
