// SPDX-License-Identifier: Apache-2.0
// Attributes a difference: did the physics diverge from the last passing run, did sensing, or did
// the grammar? Tested by tests/harness/suite/check/attribute_run_test.cc
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/suite/check/last_pass.h"
#include "harness/suite/check/settings.h"
#include "harness/suite/judge/judges.h"

namespace prehend::suite {

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
