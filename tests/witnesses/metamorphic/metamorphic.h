// SPDX-License-Identifier: Apache-2.0
// Metamorphic transforms: each transform of harness/scenario/transform/transform.h, and mirrored,
// under other names, beside a copy, at other rates. A verdict must not depend on it.
// Tested by tests/witnesses/metamorphic/metamorphic_test.cc
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "harness/suite/judge/judges.h"

namespace prehend::witnesses {

/// nudge, shift, far, turn, reorder, bystander (harness/scenario/transform/transform.h); and
/// mirror: in the plane y = 0, right hands become left ones; rename: other names, which the
/// alphabet has the other way round; copies: a second copy, 13 m away, does the same at the same
/// time; rate: physics in steps half as long, what is watched, and when, stays; watch: the grammar
/// sees twice as many frames, physics stays.
const std::vector<std::string>& TransformNames();

/// The scenario so changed, whose events are those of the original. Otherwise why the two are not
/// the same story. `transform` is one of TransformNames().
tl::expected<suite::TransformedScenario, std::string> TransformedBy(
    const episode::LoadedRun& loaded, const std::string& transform);

/// What became of one transform of a scenario.
struct TransformVerdict {
  std::string transform;
  std::string says;     ///< kSameStory, kOtherStory, kMayDiffer or kNotApplied
  std::string why;      ///< what differs, why it may, or why the transform is not applied
  std::string details;  ///< of another story: several lines
};
inline constexpr const char* kSameStory = "same";
inline constexpr const char* kOtherStory = "differs";
inline constexpr const char* kMayDiffer = "may differ";
inline constexpr const char* kNotApplied = "not applied";

/// Plays the scenario once after the transform. `here` is the unchanged run, with the tolerances of
/// its golden. Where the golden is marked as unsteady, events may differ after a change that
/// changes rounding; a claim that is broken is another story all the same, if it holds in the
/// unchanged run.
TransformVerdict JudgeTransform(const suite::CheckedRun& checked, const truth::Golden& here,
                                const std::string& transform);

}  // namespace prehend::witnesses
