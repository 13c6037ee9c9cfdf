// SPDX-License-Identifier: Apache-2.0
// What the judges of a check are given, and what they return: a run with what it was played from,
// and findings. Tested by tests/harness/suite/judge/judge_golden_test.cc and
// tests/harness/suite/judge/judge_claims_test.cc
#pragma once

#include <iterator>
#include <string>
#include <vector>

#include "grammar/base/timeline.h"
#include "harness/base/base/exit_code.h"
#include "harness/episode/run/load_run.h"
#include "harness/episode/run/run_scenario.h"
#include "harness/truth/claims/judge_claims.h"

namespace prehend::suite {

/// Something that a check found wrong.
struct Finding {
  ExitCode exit_code = ExitCode::kDiffers;  ///< of a check that finds only this
  std::string reason;                       ///< one line
  std::string details;                      ///< several lines or empty
  grammar::Diagnostics errors = {};         ///< of its input
};
using Findings = std::vector<Finding>;

inline void Append(Findings& findings, Findings more) {
  findings.insert(findings.end(), std::make_move_iterator(more.begin()),
                  std::make_move_iterator(more.end()));
}

/// A scenario that was played to its end, and recorded.
struct CheckedRun {
  std::string id;          ///< skill/name
  bool in_project = true;  ///< below scenarios/, so that it may have a golden
  episode::LoadedRun loaded;
  episode::RunResult result;
  std::string explain;  ///< the command that asks about its events
};

/// Said of a scenario that contradicts its claims.
inline constexpr const char* kUntilClaimsHold =
    "it cannot be accepted until its claims hold: change the script so that it plays what the "
    "scenario shows, or fix what is recognised";

/// `timeline` is what the grammar of `loaded` recognised.
std::vector<truth::ClaimVerdict> JudgeClaims(const episode::LoadedRun& loaded,
                                             const grammar::Timeline& timeline);

/// One per note of a run that the physics got something wrong, which the scenario does not expect;
/// one per such thing that it expects and that did not happen.
Findings JudgeLimits(const scenario::Scenario& scenario,
                     const std::vector<physics::ScriptNote>& notes);

/// One per contradicted claim.
Findings ClaimFindings(const std::vector<truth::ClaimVerdict>& verdicts);

}  // namespace prehend::suite
