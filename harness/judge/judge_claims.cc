// SPDX-License-Identifier: Apache-2.0
// See harness/judge/judge_claims.h. Tested by tests/harness/judge/judge_claims_test.cc
#include "harness/judge/judge_claims.h"

#include "harness/run/validate_claims.h"

namespace prehend::harness {

std::vector<ClaimVerdict> JudgeClaims(const LoadedRun& loaded, const grammar::Timeline& timeline) {
  const Scenario& scenario = loaded.scenario;
  if (scenario.expects.empty()) return {};
  return JudgeClaims(scenario.expects, scenario.file, ClaimableIn(scenario, *loaded.program),
                     timeline);
}

Findings ClaimFindings(const std::vector<ClaimVerdict>& verdicts) {
  Findings findings;
  for (const ClaimVerdict& verdict : verdicts) {
    if (!IsContradicted(verdict)) continue;
    const std::string text = Text(verdict);
    findings.push_back(
        {.exit_code = ExitCode::kDiffers, .reason = text, .details = text + "\n" + verdict.times});
  }
  return findings;
}

}  // namespace prehend::harness
