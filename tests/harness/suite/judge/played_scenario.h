// SPDX-License-Identifier: Apache-2.0
// A shipped scenario, simulated once, for tests that let several grammars watch it. Tested by what
// uses it.
#pragma once

#include <gtest/gtest.h>

#include "harness/episode/run/find_scenario.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/episode/run/segment_recording.h"

namespace prehend::suite {

struct PlayedScenario {
  scenario::Scenario scenario;
  episode::RunResult
      run;  ///< with its recording; its timeline is that of the scenario's own grammar

  grammar::Tick end() const { return run.ticks + 1; }
  grammar::Timeline WatchedBy(const std::shared_ptr<const grammar::Program>& program) const {
    return episode::Resegment(scenario, run.recording, program, end());
  }
};

/// `id` is skill/name. A scenario that cannot be played is a failure of the test.
inline PlayedScenario Play(const std::string& id) {
  const Result<episode::LoadedRun> loaded = episode::LoadRun(
      {.scenario_file = std::string(PREHEND_SOURCE_DIR) + "/scenarios/" + id + ".yaml"},
      PREHEND_SOURCE_DIR);
  EXPECT_TRUE(loaded) << grammar::Format(loaded.error());
  if (!loaded) return {};
  PlayedScenario played{loaded->scenario,
                        episode::RunScenario(loaded->scenario, loaded->program, {.record = true})};
  EXPECT_EQ(played.run.status.kind, physics::RunStatus::Kind::kCompleted)
      << id << ": " << played.run.status.reason;
  return played;
}

}  // namespace prehend::suite
