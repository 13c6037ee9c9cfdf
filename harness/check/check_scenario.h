// SPDX-License-Identifier: Apache-2.0
// One scenario against its golden and the invariants: play it once, draw it, compare, judge. What
// differs or has no golden leaves a pending golden behind. Tested by
// tests/program/command_line_test.cc
#pragma once

#include <string>

#include "harness/check/verdict.h"
#include "harness/process/progress_counters.h"
#include "harness/run/load_run.h"

namespace prehend::harness {

struct CheckRequest {
  RunRequest run;
  std::string id;             ///< skill/name, or the path of a scenario without golden
  std::string root;           ///< the project's
  std::string report_folder;  ///< pictures go to its folder `pictures`
  bool pictures = true;
  bool is_trial = false;   ///< leave nothing behind: neither a pending golden nor a trace
  bool has_golden = true;  ///< or may have one; false: it is not of the project
  std::string program;     ///< ProgramHash(), for the blame
  ProgressCounters::Tick* last_tick = nullptr;  ///< told how far the run came; may be null
};

/// Never fails: what goes wrong is the verdict.
ScenarioVerdict CheckScenario(const CheckRequest& request);

/// The command that asks about a scenario's events, with the grammar and settings of `changes`;
/// every difference ends with it and a question.
std::string ExplainCommand(const std::string& id, const RunRequest& changes);

/// The command that repeats a verdict.
std::string RepeatCommand(const std::string& id, const RunRequest& changes);

}  // namespace prehend::harness
