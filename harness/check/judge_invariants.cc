// SPDX-License-Identifier: Apache-2.0
// See harness/check/judge_invariants.h. Tested by tests/harness/check/judge_invariants_test.cc
#include "harness/check/judge_invariants.h"

#include "grammar/describe.h"
#include "harness/check/invariants.h"
#include "harness/golden/compare.h"

namespace prehend::harness {
namespace {

std::map<std::string, grammar::Wait> LatencyByEvent(const grammar::Program& program) {
  std::map<std::string, grammar::Wait> latency;
  for (const grammar::RuleDescription& rule : Describe(program).rules)
    latency[rule.name] = rule.latency;
  return latency;
}

}  // namespace

Findings JudgeInvariants(const CheckedRun& checked) {
  const RunResult& run = checked.result;
  const Scenario& scenario = checked.loaded.scenario;
  EpisodeFacts facts{.end = run.ticks + 1};
  facts.ticks_per_frame = DefaultTolerance(scenario.world.rate_hz, scenario.world.sensing_hz) / 2;
  facts.latency = LatencyByEvent(*checked.loaded.program);
  // A grammar without phases, as that of pouring, cannot cover a grasp with them.
  if (facts.latency.contains("transporting")) facts.movable = MovableEntities(scenario);
  std::string details;
  for (const Violation& violation : CheckInvariants(run.timeline, facts))
    details += "violated: " + Text(violation, run.timeline.ticks_per_second) + "\n";
  if (details.empty()) return {};
  return {{.exit_code = ExitCode::kDiffers,
           .reason = "invariant violated",
           .details = std::move(details)}};
}

}  // namespace prehend::harness
