// SPDX-License-Identifier: Apache-2.0
// A run against its golden and the ground truth. Tested by
// tests/harness/suite/judge/judge_golden_test.cc
#pragma once

#include <optional>
#include <span>
#include <string>

#include "harness/scenario/scenario/scenario.h"
#include "harness/suite/judge/compare_with_oracle.h"
#include "harness/suite/judge/judge.h"
#include "harness/truth/golden/compare.h"
#include "physics/scene/snapshot.h"

namespace prehend::suite {

struct GoldenComparison {
  bool has_golden = false;  ///< false: the comparison is with an empty one
  truth::Comparison comparison;
  OracleComparison truth;
  int accepted_differing = 0;  ///< from the ground truth, by the golden
  truth::Golden pending;       ///< what the run proposes

  bool Differs() const { return has_golden && !comparison.Agrees(); }
  bool TruthIsAccepted() const { return truth.Differing() == accepted_differing; }
  /// Nothing waits for review.
  bool Holds() const { return has_golden && comparison.Agrees() && TruthIsAccepted(); }
};

GoldenComparison CompareWithGolden(const std::optional<truth::Golden>& golden,
                                   const CheckedRun& checked);

/// Of a comparison that does not agree. `explain`: the command that asks about the events; `facts`
/// are shown with the first difference.
Finding DifferenceFinding(const truth::Comparison& comparison, const std::string& explain,
                          const std::string& facts = {});

/// `cause` is CauseText() of a run that differs. Without a golden the finding is that there is
/// none.
Findings JudgeGolden(const GoldenComparison& compared, const CheckedRun& checked,
                     const std::string& cause);

/// Lines indented by two blanks; "" without a recording. Contacts are as sensed: no gap is
/// tolerated.
std::string DifferenceContext(const scenario::Scenario& scenario,
                              std::span<const physics::Snapshot> recording,
                              const truth::Pairing& difference);

}  // namespace prehend::suite
