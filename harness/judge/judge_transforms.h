// SPDX-License-Identifier: Apache-2.0
// A scenario elsewhere, turned, mirrored, or in another order: the same events, boundaries within
// the tolerances of its golden. Tested by tests/harness/transform/transform_test.cc
#pragma once

#include <string>
#include <vector>

#include "harness/golden/golden.h"
#include "harness/judge/judge.h"
#include "harness/transform/transform.h"

namespace prehend::harness {

/// What an ensemble found: the scenario as its file says, and once after each of
/// EnsembleTransforms() that leaves its story the same. `here` is what the first play recognised.
struct Ensemble {
  int plays = 1;
  std::vector<Spread> spreads;  ///< by index in Golden::events; of events that all plays have
  Findings broken;       ///< plays that fail, or whose events contradict what the scenario expects
  Findings differences;  ///< one per play whose events differ by more than the tolerances
  int plays_broken = 0;
};
Ensemble PlayEnsemble(const LoadedRun& loaded, const grammar::Timeline& here, const Golden& golden);

/// Writes how far the boundaries moved into the lines of `golden`, for which it was played.
void KeepSpreads(const Ensemble& ensemble, Golden& golden);

/// What became of one transform of a scenario.
struct TransformVerdict {
  std::string transform;  ///< its name
  std::string says;       ///< kSameStory, kOtherStory, kMayDiffer or kNotApplied
  std::string why;        ///< what differs, why it may, or why the transform is not applied
};
inline constexpr const char* kSameStory = "same";
inline constexpr const char* kOtherStory = "differs";
inline constexpr const char* kMayDiffer = "may differ";
inline constexpr const char* kNotApplied = "not applied";

/// A line for each transform that was not applied, or may differ; or "".
std::string TextOfNotCompared(const std::vector<TransformVerdict>& verdicts);

struct TransformJudgement {
  std::vector<TransformVerdict> verdicts;  ///< one per transform
  Findings findings;
};

/// Plays the scenario once per transform that leaves its story the same. `here` is the
/// untransformed run, with the tolerances of its golden. Where the golden is marked as unsteady,
/// events that differ after a transform that changes rounding are no finding; a claim that is
/// broken is one all the same, if it holds in the untransformed run.
TransformJudgement JudgeTransforms(const CheckedRun& checked, const Golden& here,
                                   const std::vector<Transform>& transforms);

}  // namespace prehend::harness
