// SPDX-License-Identifier: Apache-2.0
// Failures of many scenarios, grouped by what caused them, and passes that are about to fail.
// Tested by tests/harness/suite/check/causes_test.cc
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "harness/suite/check/last_pass.h"
#include "harness/suite/check/settings.h"
#include "harness/suite/check/verdict.h"
#include "harness/suite/judge/judges.h"

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

// Attributes a difference: did the physics diverge from the last passing run, did sensing, or did
// the grammar? Tested by tests/harness/suite/check/attribute_run_test.cc

/// How a run that differs moved, and what decided it.
struct DifferingRun {
  std::string program;  ///< ProgramHash()
  std::string build;    ///< BuildText()
  FileHashes inputs;
  Settings settings;
  std::vector<std::string> options;  ///< of its command line: "--grammar original_2020"
  bool other_grammar = false;        ///< the command line chose the grammar
  StateTrace trace;
  double ticks_per_second = 480;
};

/// One line with its line feed: "cause: physics. `cup` moves differently from the last passing run,
/// first at 0.0042 s (tick 2). Changed since: ..". Paths are relative to `root`. Of another
/// build it says compiler and flags, now and then. The cause is unknown without a run that passed,
/// or was accepted.
std::string CauseText(const std::optional<LastPass>& last_pass,
                      const std::optional<StateTrace>& its_trace, const DifferingRun& now,
                      const std::string& root);

/// What may have caused the differences of a run. Nothing without a run that passed.
std::optional<PossibleCauses> PossibleCausesOf(const std::optional<LastPass>& last_pass,
                                               const std::optional<StateTrace>& its_trace,
                                               const DifferingRun& now, const std::string& root);

/// "changed: `reach_radius` 30 cm -> 20 cm in x.grammar", a line for each of at most ten.
std::string ChangesText(const std::vector<SettingChange>& changes);

/// Attributes how a run differs from its golden, as a whole and each difference. Fills `cause` and
/// `attributions` of a verdict that has its inputs and settings.
void AttributeRun(const CheckRequest& request, const CheckedRun& checked,
                  const truth::Golden& golden, const truth::Comparison& comparison,
                  ScenarioVerdict& verdict);

/// Of a run that fails although it does not differ from a golden: a law, a claim, the run itself.
void AttributeFailure(const CheckRequest& request, const CheckedRun& checked,
                      ScenarioVerdict& verdict);

/// Of a scenario that could be read when it passed.
void AttributeUnread(const CheckRequest& request, ScenarioVerdict& verdict);

}  // namespace prehend::suite
