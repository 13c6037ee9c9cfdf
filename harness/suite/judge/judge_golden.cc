// SPDX-License-Identifier: Apache-2.0
// See harness/suite/judge/judge_golden.h. Tested by tests/harness/suite/judge/judge_golden_test.cc
#include "harness/suite/judge/judge_golden.h"

#include <fmt/format.h>

#include <algorithm>

#include "harness/suite/judge/accept_golden.h"
#include "harness/suite/judge/difference_context.h"

namespace prehend::suite {
namespace {

Finding TruthFinding(const GoldenComparison& compared) {
  std::string reason = DifferingText(compared.truth.Differing());
  if (compared.accepted_differing > 0)
    reason += fmt::format(", the golden records {}", compared.accepted_differing);
  return {.exit_code = ExitCode::kDiffers,
          .reason = std::move(reason),
          .details = GroundTruthText(compared.truth)};
}

}  // namespace

Finding DifferenceFinding(const truth::Comparison& comparison, const std::string& explain,
                          const std::string& facts) {
  const auto differing =
      std::ranges::count_if(comparison.pairings, [](const truth::Pairing& pairing) {
        return pairing.agreement != truth::LineVerdict::kMatched;
      });
  return {.exit_code = ExitCode::kDiffers,
          .reason = fmt::format("{} of {} events differ from the golden", differing,
                                comparison.pairings.size()),
          .details = truth::DifferenceText(comparison, explain, facts)};
}

GoldenComparison CompareWithGolden(const std::optional<truth::Golden>& golden,
                                   const CheckedRun& checked) {
  const scenario::Scenario& scenario = checked.loaded.scenario;
  const grammar::Timeline& timeline = checked.result.timeline;
  const truth::Golden none{.ticks_per_second = timeline.ticks_per_second};
  GoldenComparison compared{
      .has_golden = golden.has_value(),
      .comparison =
          truth::Compare(golden.value_or(none), timeline, scenario::DefaultTolerance(scenario)),
      .truth = CompareWithOracle(scenario, *checked.loaded.program, checked.result),
      .accepted_differing = golden ? AcceptedDiffering(golden->derived) : 0,
      .pending = {}};
  compared.pending = PendingGolden(golden, timeline, checked.id, scenario.grammar, compared.truth);
  return compared;
}

Findings JudgeGolden(const GoldenComparison& compared, const CheckedRun& checked,
                     const std::string& cause) {
  if (!compared.has_golden)
    return {{.exit_code = ExitCode::kPending,
             .reason = checked.in_project ? "no golden yet"
                                          : "no golden: only scenarios below scenarios/ have one",
             .details = GroundTruthText(compared.truth)}};
  Findings findings;
  if (compared.Differs()) {
    const truth::Comparison& comparison = compared.comparison;
    const std::string facts = DifferenceContext(checked.loaded.scenario, checked.result.recording,
                                                *comparison.FirstDivergence());
    findings.push_back(DifferenceFinding(comparison, checked.explain, facts));
    findings.back().details += cause;
  }
  if (!compared.TruthIsAccepted()) findings.push_back(TruthFinding(compared));
  return findings;
}

}  // namespace prehend::suite
