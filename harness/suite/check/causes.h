// SPDX-License-Identifier: Apache-2.0
// Failures of many scenarios, grouped by what caused them, and passes that are about to fail.
// Tested by tests/harness/suite/check/causes_test.cc
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "harness/suite/check/verdict.h"

namespace prehend::suite {

/// What one cause does to one event.
struct Effect {
  std::string event;  ///< its name; "" of what is no event: a claim, a run that failed
  std::string what;   ///< "begins later"
  int count = 0;      ///< of differences
  double median_ms = 0, least_ms = 0, most_ms = 0;  ///< of shifts, by magnitude; else 0
  std::vector<std::string> scenarios;               ///< sorted
  std::string command;                              ///< shows it in the first scenario
};

/// "reaching begins later, median +120.0 ms (+71.0 to +196.0)".
std::string EffectText(const Effect& effect);

struct Cause {
  std::string because;                 ///< "`reach_radius` 30 cm -> 20 cm in x.grammar"; or ""
  std::vector<Effect> effects;         ///< the most frequent first
  std::vector<std::string> scenarios;  ///< sorted; a scenario may have several causes

  /// `because`, or that nothing is known: nothing has changed, or there is no earlier pass here.
  std::string Title() const { return because.empty() ? "no cause is known" : because; }
};

/// The one with most scenarios first. Without any difference from goldens, and of scenarios that
/// fail otherwise, the reason of the failure is the effect.
std::vector<Cause> CausesOf(const std::vector<ScenarioVerdict>& verdicts);

/// "2 causes:" and some lines for each, or "".
std::string CausesText(const std::vector<Cause>& causes);

/// A scenario that passed although a boundary is at the limit of its tolerance.
struct NearLimitPass {
  std::string scenario, boundary;
  double offset_ms = 0, tolerance_ms = 0;
};
/// With at most a tenth of a tolerance left; the nearest to its limit first, one line per scenario.
std::vector<NearLimitPass> NearLimitPasses(const std::vector<ScenarioVerdict>& verdicts);
/// "warning: 2 scenarios passed at the limit of a tolerance:" and a line for each, or "".
std::string NearLimitText(const std::vector<NearLimitPass>& near_limit);

/// Keys in docs/regression-suite.md.
nlohmann::ordered_json CausesJson(const std::vector<Cause>& causes);
nlohmann::ordered_json NearLimitJson(const std::vector<NearLimitPass>& near_limit);

// Demonstrations of robots that failed, grouped by what went wrong first. Tested by
// tests/program/failed_demonstrations.py

struct FailedTake {
  std::string scenario;  ///< ScenarioVerdict::scenario
  double at_s = 0;
  std::string command;  ///< asks why; or ""
};

/// The first cause of several.
struct Failure {
  std::string because;
  std::vector<FailedTake> takes;
};

struct Failures {
  std::size_t demonstrations = 0, failed = 0;
  std::vector<Failure> groups;  ///< the most frequent first
};

Failures FailuresOf(const std::vector<ScenarioVerdict>& verdicts);

/// "3 of 20 demonstrations failed:" and some lines for each cause, or "".
std::string FailuresText(const Failures& failures);

/// Keys in docs/robot-demonstrations.md.
nlohmann::ordered_json FailuresJson(const Failures& failures);

}  // namespace prehend::suite
