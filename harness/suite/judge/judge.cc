// SPDX-License-Identifier: Apache-2.0
// See harness/suite/judge/judge.h. Tested by tests/harness/suite/judge/judge_claims_test.cc
#include "harness/suite/judge/judge.h"

#include "harness/episode/run/validate_claims.h"

namespace prehend::suite {

std::vector<truth::ClaimVerdict> JudgeClaims(const episode::LoadedRun& loaded,
                                             const grammar::Timeline& timeline) {
  const scenario::Scenario& scenario = loaded.scenario;
  if (scenario.expects.empty()) return {};
  return JudgeClaims(scenario.expects, scenario.file,
                     episode::ClaimableIn(scenario, *loaded.program), timeline);
}

Findings ClaimFindings(const std::vector<truth::ClaimVerdict>& verdicts) {
  Findings findings;
  for (const truth::ClaimVerdict& verdict : verdicts) {
    if (!truth::IsContradicted(verdict)) continue;
    const std::string text = Text(verdict);
    findings.push_back(
        {.exit_code = ExitCode::kDiffers, .reason = text, .details = text + "\n" + verdict.times});
  }
  return findings;
}

}  // namespace prehend::suite
