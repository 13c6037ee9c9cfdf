// SPDX-License-Identifier: Apache-2.0
// A scenario after metamorphic transforms: the same events, boundaries within the tolerances of its
// golden. Tested by tests/harness/suite/judge/ensemble_test.cc and
// tests/witnesses/metamorphic/metamorphic_test.cc
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/suite/judge/judge.h"
#include "harness/truth/claims/judge_claims.h"
#include "harness/truth/golden/compare.h"

namespace prehend::suite {

/// What an ensemble found: the scenario as its file says, and once after each of kTransforms that
/// leaves its story the same. `here` is what the first play recognised.
struct Ensemble {
  int plays = 1;
  std::vector<truth::Spread>
      spreads;           ///< by index in Golden::events; of events that all plays have
  Findings broken;       ///< plays that fail, or whose events contradict what the scenario expects
  Findings differences;  ///< one per play whose events differ by more than the tolerances
  int plays_broken = 0;
};
Ensemble PlayEnsemble(const episode::LoadedRun& loaded, const grammar::Timeline& here,
                      const truth::Golden& golden);

/// Writes how far the boundaries moved into the lines of `golden`, for which it was played.
void KeepSpreads(const Ensemble& ensemble, truth::Golden& golden);

/// A scenario after a change that leaves its story the same.
struct TransformedScenario {
  std::string name;  ///< of the change
  scenario::Scenario scenario;
  /// Of boundaries without one of their own, in ticks of this scenario.
  grammar::Tick tolerance = 0;
  /// Gives events the names of the original, in a timeline that stays sorted; empty: they have
  /// them.
  std::function<void(grammar::Timeline&)> rename_back = {};
};

struct TransformedPlay {
  Findings failed;                              ///< to come to its end
  std::vector<truth::ClaimVerdict> claims;      ///< of what the scenario expects, here as there
  Findings differs;                             ///< from the golden
  std::optional<truth::Comparison> comparison;  ///< of a play that came to its end
};
/// Events of those who are not in the original are left out.
TransformedPlay Play(const TransformedScenario& there, const episode::LoadedRun& original,
                     const truth::Golden& here);

/// What is wrong with it whatever a golden says.
Findings BrokenIn(const TransformedPlay& play, const std::string& name);

}  // namespace prehend::suite
