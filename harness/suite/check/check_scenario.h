// SPDX-License-Identifier: Apache-2.0
// The check of one scenario or episode: play it once or read it, ask the judges, then store what
// the next check and `prehend review` need. Tested by
// tests/harness/suite/check/check_scenario_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/suite/check/check_request.h"
#include "harness/suite/check/verdict.h"

namespace prehend::suite {

/// Never fails: what goes wrong is the verdict. Of a recording, which is not simulated, the events
/// alone are judged, against the golden beside it.
ScenarioVerdict CheckScenario(const CheckRequest& request);

/// The same of a run that was played already, with its recording. `files`: what it was read from.
ScenarioVerdict JudgeRun(const CheckRequest& request, episode::LoadedRun loaded,
                         episode::RunResult run, const std::vector<std::string>& files);

}  // namespace prehend::suite
