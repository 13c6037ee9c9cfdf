// SPDX-License-Identifier: Apache-2.0
// The check of one scenario: play it once, draw it, judge it, then store what the next check and
// `prehend review` need. Tested by tests/harness/check/check_scenario_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/check/verdict.h"
#include "harness/process/progress_counters.h"
#include "harness/run/load_run.h"

namespace prehend::harness {

/// Of which verdicts the report gets a 3D replay.
enum class Replays { kNone, kFailures, kAll };

struct CheckRequest {
  RunRequest run;
  std::int64_t episode = 0;          ///< not 0: this one of the episode file `run.scenario_file`
  std::string id;                    ///< skill/name, or the path of a scenario outside the project
  std::string root;                  ///< the project's
  std::string report_folder;         ///< pictures go to its folder `pictures`
  Replays replays = Replays::kNone;  ///< kFailures: of what has not passed
  bool explain = false;              ///< what has a golden and does not pass
  bool pictures = true;
  bool leave_nothing_behind = false;  ///< no pending golden, no trace; only the verdict
  bool in_project = true;             ///< below scenarios/, so that it may have a golden
  std::string record_file;            ///< an episode file that gets the run; or empty
  std::string today;                  ///< YYYY-MM-DD, for that file
  std::string program;                ///< ProgramHash(), to find the cause of differences
  ProgressCounters::Tick* last_tick =
      nullptr;  ///< gets the tick that the run has reached; may be null
};

/// Never fails: what goes wrong is the verdict. Of a recording of a tracker, which is not
/// simulated, it judges the events alone, against the golden beside it.
ScenarioVerdict CheckScenario(const CheckRequest& request);

/// The same of a run that was played already, with its recording. `files`: what it was read from.
ScenarioVerdict JudgeRun(const CheckRequest& request, LoadedRun loaded, RunResult run,
                         const std::vector<std::string>& files);

/// The command that asks about a scenario's events, with the grammar and settings of `changes`.
std::string ExplainCommand(const std::string& id, const RunRequest& changes);

/// The command that repeats a verdict: of the same scenario or episode, with the same changes.
std::string RepeatCommand(const CheckRequest& request);

}  // namespace prehend::harness
