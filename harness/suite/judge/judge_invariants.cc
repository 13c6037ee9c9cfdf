// SPDX-License-Identifier: Apache-2.0
// See harness/suite/judge/judge_invariants.h. Tested by
// tests/harness/suite/judge/judge_invariants_test.cc
#include "harness/suite/judge/judge_invariants.h"

#include "grammar/check_laws.h"
#include "grammar/describe.h"
#include "harness/episode/sense/entity_table.h"
#include "harness/suite/judge/invariants.h"
#include "harness/truth/golden/compare.h"
#include "harness/truth/timeline/event_text.h"

namespace prehend::suite {
namespace {

std::map<std::string, grammar::Wait> LatencyByEvent(const grammar::Program& program) {
  std::map<std::string, grammar::Wait> latency;
  for (const grammar::RuleDescription& rule : Describe(program).rules)
    latency[rule.name] = rule.latency;
  return latency;
}

Findings ViolationFinding(const char* reason, std::string details) {
  if (details.empty()) return {};
  return {{.exit_code = ExitCode::kDiffers, .reason = reason, .details = std::move(details)}};
}

}  // namespace

Findings JudgeInvariants(const CheckedRun& checked) {
  const episode::RunResult& run = checked.result;
  const scenario::Scenario& scenario = checked.loaded.scenario;
  EpisodeFacts facts{.end = run.ticks + 1};
  facts.ticks_per_frame = scenario::DefaultTolerance(scenario) / 2;
  facts.latency = LatencyByEvent(*checked.loaded.program);
  std::string details;
  for (const Violation& violation : CheckInvariants(run.timeline, facts))
    details += "violated: " + Text(violation, run.timeline.ticks_per_second) + "\n";
  return ViolationFinding("invariant violated", std::move(details));
}

Findings JudgeLaws(const CheckedRun& checked) {
  const grammar::Timeline& timeline = checked.result.timeline;
  std::string details;
  for (const grammar::LawViolation& violation : CheckLaws(
           *checked.loaded.program, episode::MakeEntityTable(checked.loaded.scenario), timeline))
    details += "violated: " + Text(violation, timeline.ticks_per_second) + "\n";
  return ViolationFinding("a law of the grammar is violated", std::move(details));
}

}  // namespace prehend::suite
