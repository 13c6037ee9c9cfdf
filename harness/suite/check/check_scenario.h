// SPDX-License-Identifier: Apache-2.0
// The check of one scenario or episode: play it once or read it, ask the judges, then store what
// the next check and `prehend review` need. Tested by
// tests/harness/suite/check/check_scenario_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/episode/run/run_scenario.h"
#include "harness/suite/check/last_pass.h"
#include "harness/suite/check/verdict.h"

namespace prehend::suite {

/// Never fails: what goes wrong is the verdict. Of a recording, which is not simulated, the events
/// alone are judged, against the golden beside it.
ScenarioVerdict CheckScenario(const CheckRequest& request);

/// The same of a run that was played already, with its recording. `files`: what it was read from.
ScenarioVerdict JudgeRun(const CheckRequest& request, episode::LoadedRun loaded,
                         episode::RunResult run, const std::vector<std::string>& files);

// Pictures of the moments about which a golden and a run differ. Tested by
// tests/harness/suite/check/draw_differences_test.cc

/// The first kMostDrawnDifferences boundaries that are out of their tolerance, as the scene at both
/// of their times, in one view, which is near to what happens in between; and events that only one
/// side has, as the scene where they begin, with what hands do according to the one and the other.
/// Files are below REPORT_FOLDER/pictures. Empty if there are none, or nothing can be drawn.
std::vector<DrawnDifference> DrawDifferences(const scenario::Scenario& scenario,
                                             const episode::RunResult& run,
                                             const truth::Comparison& comparison,
                                             const std::string& report_folder);

}  // namespace prehend::suite
