// SPDX-License-Identifier: Apache-2.0
#include "harness/suite/judge/judge.h"

#include <fmt/format.h>

#include <map>

#include "harness/episode/run/load_run.h"
#include "physics/scene/run_limits.h"

namespace prehend::suite {

std::vector<truth::ClaimVerdict> JudgeClaims(const episode::LoadedRun& loaded,
                                             const grammar::Timeline& timeline) {
  const scenario::Scenario& scenario = loaded.scenario;
  if (scenario.expects.empty()) return {};
  return JudgeClaims(scenario.expects, scenario.file,
                     episode::ClaimableIn(scenario, *loaded.program), timeline);
}

Findings JudgeLimits(const scenario::Scenario& scenario,
                     const std::vector<physics::ScriptNote>& notes) {
  std::map<std::string, std::string> found;  // by what a claim says of it
  for (const physics::ScriptNote& note : notes)
    if (const std::string limit = physics::LimitOf(note.text); !limit.empty())
      found.emplace(limit, note.text);
  Findings findings;
  for (const truth::Claim& claim : scenario.expects) {
    if (!truth::IsAboutLimit(claim)) continue;
    const std::vector<truth::ClaimRole>& roles = claim.events.front().roles;
    const std::string limit = fmt::format("{}({}, {})", claim.events.front().name.text,
                                          roles[0].value.text, roles[1].value.text);
    if (found.erase(limit) > 0) continue;
    const std::string text = fmt::format("expects: '{}' ({}:{}): found none", claim.text,
                                         scenario.file, claim.where.place.line);
    findings.push_back({.exit_code = ExitCode::kDiffers, .reason = text, .details = text + "\n"});
  }
  for (const auto& [limit, text] : found)
    findings.push_back(
        {.exit_code = ExitCode::kDiffers,
         .reason = text,
         .details = fmt::format("{}\n  if that may be: expects: ['{}']\n", text, limit)});
  return findings;
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
