// SPDX-License-Identifier: Apache-2.0
// See harness/judge/judge_invariants.h. Tested by tests/harness/judge/judge_invariants_test.cc
#include "harness/judge/judge_invariants.h"

#include "grammar/check_laws.h"
#include "grammar/describe.h"
#include "harness/golden/compare.h"
#include "harness/judge/invariants.h"
#include "harness/sense/entity_table.h"
#include "harness/timeline/event_text.h"

namespace prehend::harness {
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
  const RunResult& run = checked.result;
  const Scenario& scenario = checked.loaded.scenario;
  EpisodeFacts facts{.end = run.ticks + 1};
  facts.ticks_per_frame = DefaultTolerance(scenario) / 2;
  facts.latency = LatencyByEvent(*checked.loaded.program);
  std::string details;
  for (const Violation& violation : CheckInvariants(run.timeline, facts))
    details += "violated: " + Text(violation, run.timeline.ticks_per_second) + "\n";
  return ViolationFinding("invariant violated", std::move(details));
}

Findings JudgeLaws(const CheckedRun& checked) {
  const grammar::Timeline& timeline = checked.result.timeline;
  std::string details;
  for (const grammar::LawViolation& violation :
       CheckLaws(*checked.loaded.program, MakeEntityTable(checked.loaded.scenario), timeline))
    details += "violated: " + Text(violation, timeline.ticks_per_second) + "\n";
  return ViolationFinding("a law of the grammar is violated", std::move(details));
}

}  // namespace prehend::harness
