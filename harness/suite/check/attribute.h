// SPDX-License-Identifier: Apache-2.0
// Why each single difference from the golden is there. Each changed parameter and each changed
// clause of a rule is undone by itself, then all of a rule, and the recorded motion is segmented
// once more: what then agrees with the golden was its effect. What differs even with all of them
// undone is attributed to what else changed. So two causes in one scenario are told apart. Tested
// by tests/harness/suite/check/attribute_test.cc
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/suite/check/settings.h"
#include "harness/truth/golden/compare.h"

namespace prehend::suite {

/// A difference of a scenario, and what it is attributed to.
struct Attribution {
  std::string event;     ///< its name; "" of a failure that is no difference, as of a law
  std::string what;      ///< "begins later", "missing", "object: milk -> cup"
  double shift_ms = 0;   ///< of the boundary that moved most, recognised - expected; else 0
  std::string because;   ///< "`reach_radius` 30 cm -> 20 cm in x.grammar"; "" is unknown
  std::string question;  ///< to `prehend explain`
};

/// What is known about a run that differs.
struct PossibleCauses {
  std::vector<SettingChange> changes;      ///< of values since the last pass
  std::vector<std::string> other_changes;  ///< changed files without a changed value, the program
  bool motion_differs = false;             ///< it moves differently from the last pass
};

/// The comparison of the same recorded motion, with these parameters and clauses set back. Nothing
/// if that cannot be done.
using CompareWith = std::function<std::optional<truth::Comparison>(
    const std::vector<const SettingChange*>& undone)>;

/// One for each of comparison.Differing(), in its order. Undoes at most 8 changes.
std::vector<Attribution> AttributeDifferences(const truth::Comparison& comparison,
                                              const PossibleCauses& possible,
                                              const CompareWith& compare_with);

/// Why a scenario fails that agrees with its golden, or cannot be read: the first changes without
/// which it holds, else what else changed. Without `holds_without`, all that changed.
std::string CauseOfFailure(
    const PossibleCauses& possible,
    const std::function<bool(const std::vector<const SettingChange*>& undone)>& holds_without);

}  // namespace prehend::suite
