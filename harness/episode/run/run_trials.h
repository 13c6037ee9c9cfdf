// SPDX-License-Identifier: Apache-2.0
// Runs many seeded variations (`vary:`) of one scenario and classifies each by its `outcomes:`.
// Tested by tests/harness/episode/run/run_trials_test.cc
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "harness/episode/run/load_run.h"
#include "harness/scenario/scenario/scenario.h"
#include "physics/scene/scene.h"
#include "physics/scene/snapshot.h"

namespace prehend::episode {

// Watches a run and finds which of the scenario's outcomes it ended with. Tested by
// tests/harness/episode/run/outcome_test.cc

/// The outcome of a run that fits none of the scenario's outcomes.
inline constexpr const char* kOtherOutcome = "other";

class OutcomeWatch {
 public:
  /// Both must outlive the watch.
  OutcomeWatch(const physics::Scene& scene, const std::vector<scenario::Outcome>& outcomes);

  /// To be called with every snapshot, in order.
  void Look(const physics::Snapshot& snapshot);
  /// After the last snapshot: the first outcome whose conditions all hold, or kOtherOutcome.
  std::string Judge(const physics::Snapshot& last) const;

 private:
  /// A condition with a time of its own.
  struct TimedCondition {
    std::int64_t tick;
    std::size_t outcome, condition;
    bool holds;
  };
  bool Holds(const scenario::Outcome::Condition& condition,
             const physics::Snapshot& snapshot) const;

  double ShareInside(const scenario::Outcome::Condition& condition,
                     const physics::Snapshot& snapshot) const;

  const physics::Scene& scene_;
  const std::vector<scenario::Outcome>& outcomes_;
  std::vector<TimedCondition> timed_;
};

struct TrialResult {
  int trial = 1;
  std::string outcome;       ///< one of the scenario's, "other" or "failed"
  std::string reason;        ///< why it failed, if it did
  std::string not_recorded;  ///< why it is not in the episode file, if it should be
};

struct TrialSettings {
  int count = 1;
  int part = 1, parts = 1;  ///< only trial part, part + parts, ..
  int jobs = 1;             ///< processes at a time
  /// Plays a trial in a process of its own, to do more than to classify it. Empty: physics only.
  /// `files`: as LoadRun() says.
  std::function<TrialResult(int trial, const RunRequest& varied, const LoadedRun& loaded,
                            const std::vector<std::string>& files)>
      play = {};
  std::map<int, TrialResult> known = {};  ///< these are not played
};

struct TrialReport {
  std::vector<std::string> outcomes;  ///< of the scenario; the first is the intended one
  std::vector<TrialResult> results;   ///< trial 1, 2, ...; of a part, its own
};

/// Why no trial of it can be played and classified; to be asked before anything is written.
grammar::Diagnostics WhyNotTried(const RunRequest& request, const std::string& root);

/// Runs the trials 1 .. count of a scenario, or a part of them.
Result<TrialReport> RunTrials(const RunRequest& request, const std::string& root,
                              const TrialSettings& settings,
                              const std::function<void(int done)>& progress = {});

/// The request, with the values drawn for one trial added to its settings.
Result<RunRequest> RequestOfTrial(const RunRequest& request, const std::string& root, int trial);

/// The drawn values of such a request, a line each: "sampled: entities.drawer.mass_kg=1.1".
std::string SampledText(const RunRequest& request, const RunRequest& varied);

/// For programs: `trials`, `outcomes` (name to count) and `results` (`trial`, `outcome`, `reason`).
nlohmann::ordered_json TrialJson(const TrialReport& report);

/// The count of each outcome, and the trials that did not end with the first one, each with the
/// command that repeats it: `command` and the number of the trial.
std::string TrialTable(const TrialReport& report, const std::string& command);

}  // namespace prehend::episode
