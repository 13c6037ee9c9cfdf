// SPDX-License-Identifier: Apache-2.0
// Many seeded variations of one scenario (`vary:`), each judged by the scenario's `outcomes:`.
// Tested by tests/harness/run/run_trials_test.cc
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "harness/run/load_run.h"

namespace prehend::harness {

struct TrialSettings {
  int count = 1;
  int jobs = 1;  ///< processes at a time
};

struct TrialResult {
  int trial = 1;
  std::string outcome;  ///< one of the scenario's, "other" or "failed"
  std::string reason;   ///< why it failed
};

struct TrialReport {
  std::vector<std::string> outcomes;  ///< of the scenario, the wanted one first
  std::vector<TrialResult> results;   ///< trial 1, 2, ...
};

/// Trial 1 .. count of a scenario. Complains when it has no outcomes.
ReadResult<TrialReport> RunTrials(const RunRequest& request, const std::string& root,
                                  const TrialSettings& settings,
                                  const std::function<void(int done)>& progress = {});

/// The request with the draws of one trial added to its settings.
ReadResult<RunRequest> RequestOfTrial(const RunRequest& request, const std::string& root,
                                      int trial);

/// For programs: `trials`, `outcomes` (name to count) and `results` (`trial`, `outcome`, `reason`).
nlohmann::ordered_json TrialJson(const TrialReport& report);

/// How often each outcome came, and the trials that did not end with the first one, each with the
/// command that shows it again: `command` and the trial's number.
std::string TrialTable(const TrialReport& report, const std::string& command);

}  // namespace prehend::harness
